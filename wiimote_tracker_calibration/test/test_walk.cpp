// A walk with the LED before anything is calibrated.

#include "capture/walk.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::capture {
namespace {

class WalkTest : public testing::Test {
 protected:
  /// 30 images of each camera, with the LED from left to right.
  void cross(const std::vector<std::string>& cameras, double start) {
    for (int i = 0; i < 30; ++i) {
      for (const std::string& camera : cameras)
        walk_.add({camera, start + 0.01 * i, 0, {{1024.0 * i / 30, 400.0}}, {}}, 1024, 768);
    }
  }
  Walk walk_;
};

TEST_F(WalkTest, SaysWhereEachCameraSawTheLedAndWhichSawItTogether) {
  EXPECT_EQ(walk_.sentence(), "");
  cross({"a", "b"}, 10.0);
  EXPECT_EQ(
      walk_.sentence(),
      "share of the image in which the LED was seen: a 17 %, b 17 %; seen together: every two "
      "of them");
  cross({"c"}, 20.0);
  EXPECT_DOUBLE_EQ(walk_.share("a"), 8.0 / 48.0);
  EXPECT_EQ(walk_.share("nobody"), 0.0);
  EXPECT_EQ(walk_.seenWith("a"), std::vector<std::string>{"b"});
  EXPECT_EQ(walk_.seenWith("b"), std::vector<std::string>{"a"});
  EXPECT_TRUE(walk_.seenWith("c").empty());
  EXPECT_EQ(
      walk_.sentence(),
      "share of the image in which the LED was seen: a 17 %, b 17 %, c 17 %; seen together: a + b; "
      "cameras that saw it alone: c; turn them towards what the others see");
  walk_.restart();
  EXPECT_EQ(walk_.sentence(), "");
}

TEST_F(WalkTest, OneGlanceTogetherIsAnAccident) {
  cross({"a"}, 10.0);
  walk_.add({"b", 10.1, 0, {{500.0, 400.0}}, {}}, 1024, 768);
  EXPECT_TRUE(walk_.seenWith("b").empty());
}

TEST_F(WalkTest, ImagesWithSeveralSpotsShowNobodyKnowsWhat) {
  walk_.add({"a", 10.0, 0, {{500.0, 400.0}, {10.0, 10.0}}, {}}, 1024, 768);
  walk_.add({"a", 10.0, 0, {}, {}}, 1024, 768);
  EXPECT_EQ(walk_.sentence(), "");
}

TEST_F(WalkTest, SpotsOnTheBorderCountAsInside) {
  walk_.add({"a", 10.0, 0, {{1024.0, 768.0}}, {}}, 1024, 768);
  walk_.add({"a", 10.0, 0, {{-1.0, -1.0}}, {}}, 1024, 768);
  EXPECT_DOUBLE_EQ(walk_.share("a"), 2.0 / 48.0);
}

}  // namespace
}  // namespace wiimote_tracker::capture
