// Files that earlier versions wrote are read, and those of later versions are refused by version.
#include "body/bodies_file.h"
#include "gesture/examples_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/identity/codes_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

namespace wiimote_tracker {
namespace {

const std::filesystem::path kVersion1 = VERSION_1;

TEST(FilesOfVersion1, AreRead) {
  const geometry::Rig rig = geometry::readRigFile(kVersion1 / "rig.yaml");
  ASSERT_EQ(4u, rig.cameras.size());
  EXPECT_EQ("wiimote_1", rig.cameras[0].camera.name);
  EXPECT_EQ(1024, rig.cameras[0].camera.intrinsics.width);
  EXPECT_EQ(4 * 16, rig.covariance.rows());
  EXPECT_EQ(1u, body::readBodies(kVersion1 / "bodies.yaml").size());
  const std::vector<gesture::Example> examples = gesture::readExamples(kVersion1 / "gestures.yaml");
  ASSERT_EQ(1u, examples.size());
  EXPECT_EQ("circle", examples[0].gesture);
  EXPECT_FALSE(identity::readBlinkCodes(kVersion1 / "blink_codes.yaml").codes.empty());
}

TEST(FilesOfALaterVersion, AreRefusedInWords) {
  const std::pair<const char*, std::function<void(const std::string&)>> readers[] = {
      {"rig.yaml", [](const std::string& file) { geometry::readRigFile(file); }},
      {"bodies.yaml", [](const std::string& file) { body::readBodies(file); }},
      {"gestures.yaml", [](const std::string& file) { gesture::readExamples(file); }},
      {"blink_codes.yaml", [](const std::string& file) { identity::readBlinkCodes(file); }}};
  for (const auto& [name, read] : readers) {
    std::ostringstream text;
    text << std::ifstream(kVersion1 / name).rdbuf();
    std::string later = text.str();
    later.replace(later.find("version: 1"), 10, "version: 2");
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / (std::to_string(::getpid()) + name);
    std::ofstream(file) << later;
    try {
      read(file);
      ADD_FAILURE() << name << " was read";
    } catch (const geometry::Error& error) {
      EXPECT_NE(std::string::npos, std::string(error.what()).find("version")) << error.what();
    }
    std::filesystem::remove(file);
  }
}

}  // namespace
}  // namespace wiimote_tracker
