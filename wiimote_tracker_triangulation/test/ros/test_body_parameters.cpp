// The file of bodies that the parameters name.
#include "ros/tracker/body_parameters.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

namespace fs = std::filesystem;

TEST(BodyParameters, SayThatTheFileOfBodiesDoesNotExist) {
  EXPECT_EQ("", describeMissingFile("")) << "none is named";
  const fs::path file =
      fs::temp_directory_path() / ("test_body_parameters_" + std::to_string(::getpid()) + ".yaml");
  const std::string sentence = describeMissingFile(file.string());
  EXPECT_NE(std::string::npos, sentence.find(file.string())) << sentence;
  EXPECT_NE(std::string::npos, sentence.find("learn_body")) << sentence;
  std::ofstream(file.string()) << "format: wiimote_tracker_bodies\n";
  EXPECT_EQ("", describeMissingFile(file.string()));
  fs::remove(file);
  fs::create_symlink(file, file);  // whether it exists cannot be told
  EXPECT_NO_THROW(describeMissingFile(file.string()));
  fs::remove(file);
}

TEST(BodyParameters, WarnOnceOfTwoBodiesOfOneShape) {
  const body::Constellation wand{
      "wand",
      {{0.05, 0.09, 0.07}, {-0.02, 0.02, -0.05}, {-0.07, -0.07, 0.03}, {0.06, -0.05, -0.05}}};
  EXPECT_TRUE(shapeWarnings({wand}).empty());
  body::Constellation twin = wand;
  twin.name = "twin";
  const std::vector<std::string> warnings = shapeWarnings({wand, twin});
  ASSERT_EQ(1u, warnings.size());
  EXPECT_EQ(0u, warnings[0].find("bodies 'wand' and 'twin' have the same shape")) << warnings[0];
}

TEST(BodyParameters, WarnOfLabelsThatNoBlinkCodeHas) {
  body::Constellation wand{"wand", {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}}};
  EXPECT_TRUE(labelWarnings({wand}, {}).empty()) << "it has no labels";
  wand.labels = {"a", "x", "y"};
  EXPECT_TRUE(labelWarnings({wand}, {"x", "y", "z", "a"}).empty());
  const std::vector<std::string> warnings = labelWarnings({wand}, {"a", "b", "c"});
  ASSERT_EQ(1u, warnings.size());
  EXPECT_EQ(0u, warnings[0].find("body 'wand' has labels without a blink code (x, y), so that "))
      << warnings[0];
}

}  // namespace
}  // namespace wiimote_tracker
