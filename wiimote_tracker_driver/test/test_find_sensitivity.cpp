// The program find_sensitivity, with a driver and a virtual remote in a room with a lamp.
#include "driver_fixture.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace wiimote_tracker::driver {
namespace {

// Seen from wii_5 up.
const virtual_wiimote::Light kLamp{200.0, 600.0, {}, 0.0105};
// Seen from wii_4 up.
const virtual_wiimote::Light kLed{700.0, 300.0, {}, 0.02};

/// A program whose questions are answered.
class Program {
 public:
  explicit Program(const std::string& command) {
    const std::string answers = folder_ / "answers";
    ::mkfifo(answers.c_str(), 0600);
    output_ = ::popen((command + " <" + answers + " 2>&1").c_str(), "r");
    answers_.open(answers);
  }
  ~Program() {
    if (output_ != nullptr)
      end();
  }

  /// Reads on until a line contains the part. @returns whether one did.
  bool says(const std::string& part) {
    char line[1000];
    while (std::fgets(line, sizeof(line), output_) != nullptr) {
      said += line;
      if (std::string(line).find(part) != std::string::npos)
        return true;
    }
    return false;
  }

  void pressEnter() { answers_ << std::endl; }

  /// Waits for its end. @returns the exit status.
  int end() {
    answers_.close();
    const int status = ::pclose(output_);
    output_ = nullptr;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string said;

 private:
  TemporaryFolder folder_;
  FILE* output_;
  std::ofstream answers_;
};

class FindSensitivity : public testing::Test {
 protected:
  FindSensitivity() : remote_(ros::param::param<std::string>("~socket", ""), "00:1f:32:00:00:01") {}

  void show(const std::vector<virtual_wiimote::Light>& lights) {
    virtual_wiimote::Senses senses;
    senses.lights = lights;
    remote_.sense(senses);
  }

  static std::string sensitivity() {
    return ros::param::param<std::string>("/room/driver/ir_sensitivity", "");
  }

  void run(const std::string& arguments) {
    show({kLamp});
    // The program waits for some seconds only.
    ASSERT_TRUE(ros::service::waitForService("/room/driver/set_parameters", ros::Duration(30.0)));
    ASSERT_TRUE(spinUntil([&] { return remote_.server.connected(); }));
    Program program("rosrun wiimote_tracker_driver find_sensitivity room --seconds 0.1 " +
                    arguments);
    ASSERT_TRUE(program.says("Switch the LED off")) << program.said;
    program.pressEnter();
    ASSERT_TRUE(program.says("Switch the LED on")) << program.said;
    show({kLamp, kLed});
    program.pressEnter();
    EXPECT_TRUE(
        program.says("Sensitivity wii_4 sees the LED in 100 % of the images and no foreign light"))
        << program.said;
    EXPECT_TRUE(program.says("ir_sensitivity: wii_4")) << program.said;
    EXPECT_EQ(0, program.end());
  }

  Remote remote_;
};

TEST_F(FindSensitivity, LeavesTheDriverAsItWas) {
  run("");
  EXPECT_EQ("wii_2", sensitivity());
}

TEST_F(FindSensitivity, AppliesItsRecommendation) {
  run("--apply");
  EXPECT_EQ("wii_4", sensitivity());
}

TEST_F(FindSensitivity, AdvisesWithoutADriver) {
  Program program("rosrun wiimote_tracker_driver find_sensitivity elsewhere");
  EXPECT_TRUE(program.says("roslaunch wiimote_tracker_driver driver.launch camera:=elsewhere"));
  EXPECT_EQ(1, program.end());
}

}  // namespace
}  // namespace wiimote_tracker::driver
