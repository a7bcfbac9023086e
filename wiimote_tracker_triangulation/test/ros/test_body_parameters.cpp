// The file of bodies that the parameters name.
#include "ros/bodies/body_parameters.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

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
}

}  // namespace
}  // namespace wiimote_tracker
