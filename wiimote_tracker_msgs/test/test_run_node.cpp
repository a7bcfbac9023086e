// What a node says of its arguments; without a master, as whoever asks for help may have none.

#include "wiimote_tracker_msgs/run_node.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

class RunNodeTest : public testing::Test {
 protected:
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), "/lib/package/some_node");
    std::vector<char*> arguments;
    for (std::string& word : words)
      arguments.push_back(word.data());
    arguments.push_back(nullptr);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int status =
        runNode(static_cast<int>(words.size()), arguments.data(), "node", "Does this.\nRate [Hz].",
                [this](const auto&, const auto&) { has_run_ = true; });
    output_ = testing::internal::GetCapturedStdout();
    errors_ = testing::internal::GetCapturedStderr();
    return status;
  }

  bool has_run_ = false;
  std::string output_, errors_;
};

TEST_F(RunNodeTest, HelpSaysWhatTheNodeDoesAndEnds) {
  for (const char* word : {"--help", "-h"}) {
    EXPECT_EQ(run({"__name:=other", word}), 0);
    EXPECT_EQ(output_.rfind("usage: some_node [options]\nDoes this.\nRate [Hz].\n", 0), 0u)
        << output_;
    EXPECT_EQ(errors_, "");
    EXPECT_FALSE(has_run_);
  }
}

TEST_F(RunNodeTest, RefusesAWordThatRosDoesNotKnow) {
  EXPECT_EQ(run({"other:=topic", "/dev/hidraw0"}), 2);
  EXPECT_NE(errors_.find("'/dev/hidraw0' is one argument too many"), std::string::npos) << errors_;
  EXPECT_FALSE(has_run_);
}

TEST_F(RunNodeTest, SaysWhatToCorrectInTheAddressOfTheMaster) {
  for (const char* address :
       {"", "lab", "lab:11311", "http://lab", "http://:11311", "http://lab:x"}) {
    setenv("ROS_MASTER_URI", address, 1);
    EXPECT_EQ(run({}), 1);
    const std::string given = *address == '\0' ? "empty" : address;
    EXPECT_EQ(errors_, "some_node: ROS_MASTER_URI is " + given +
                           ", but must be such as http://HOST:11311: correct it\n");
    EXPECT_EQ(run({"--help"}), 0);
  }
  EXPECT_FALSE(has_run_);
}

TEST_F(RunNodeTest, SeeksTheMasterWhereRospyDoesIfNoAddressIsGiven) {
  ::unsetenv("ROS_MASTER_URI");
  run({});
  EXPECT_EQ(errors_.find("ROS_MASTER_URI"), std::string::npos) << errors_;
}

}  // namespace
}  // namespace wiimote_tracker
