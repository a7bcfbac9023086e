// Files that earlier versions wrote are read, and those of later versions are refused by version.
#include "body/bodies_file.h"
#include "gesture/examples_file.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/identity/codes_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <string>

namespace wiimote_tracker {
namespace {

const std::filesystem::path kVersion1 = VERSION_1;

TEST(FilesOfVersion1, AreRead) {
  const geometry::Rig rig = geometry::readRigFile(kVersion1 / "rig.yaml");
  ASSERT_EQ(4u, rig.cameras.size());
  EXPECT_EQ("wiimote_1", rig.cameras[0].camera.name);
  EXPECT_EQ(1024, rig.cameras[0].camera.intrinsics.width);
  EXPECT_EQ(4 * 16, rig.covariance.rows());
  EXPECT_FALSE(rig.square_pose) << "was not written then";
  EXPECT_EQ(1u, body::readBodies(kVersion1 / "bodies.yaml").size());
  const std::vector<gesture::Example> examples = gesture::readExamples(kVersion1 / "gestures.yaml");
  ASSERT_EQ(1u, examples.size());
  EXPECT_EQ("circle", examples[0].gesture);
  EXPECT_FALSE(identity::readBlinkCodes(kVersion1 / "blink_codes.yaml").codes.empty());
}

TEST(ExampleRig, IsRead) {
  const geometry::Rig rig = geometry::readRigFile(EXAMPLE_RIG);
  ASSERT_EQ(1u, rig.cameras.size());
  EXPECT_EQ(Eigen::Vector3d(0.0, 0.0, 2.0), rig.cameras[0].camera.center());
}

struct Reader {
  const char* file;
  std::function<void(const std::string&)> read;
};

const Reader kReaders[] = {
    {"rig.yaml", [](const std::string& file) { geometry::readRigFile(file); }},
    {"bodies.yaml", [](const std::string& file) { body::readBodies(file); }},
    {"gestures.yaml", [](const std::string& file) { gesture::readExamples(file); }},
    {"blink_codes.yaml", [](const std::string& file) { identity::readBlinkCodes(file); }}};

std::string contentOf(const char* name) {
  std::ostringstream text;
  text << std::ifstream(kVersion1 / name).rdbuf();
  return text.str();
}

/// Reads a file with this content. @returns why it is refused.
std::string refusal(const Reader& reader, const std::string& content) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / (std::to_string(::getpid()) + reader.file);
  std::ofstream(file) << content;
  const std::string said = refusalOf([&] { reader.read(file); });
  std::filesystem::remove(file);
  return said;
}

TEST(FilesOfALaterVersion, AreRefusedInWords) {
  for (const Reader& reader : kReaders) {
    std::string later = contentOf(reader.file);
    later.replace(later.find("version: 1"), 10, "version: 2");
    EXPECT_NE(std::string::npos, refusal(reader, later).find("version is 2")) << reader.file;
  }
}

TEST(DamagedFiles, AreReadOrRefusedInWords) {  // rig.yaml: see test_rig_file.cpp
  constexpr int kChanges = 2000;
  std::mt19937_64 random(1);
  for (const Reader& reader : kReaders) {
    if (reader.file == std::string("rig.yaml"))
      continue;
    const std::string whole = contentOf(reader.file);
    int refused = 0;
    for (int i = 0; i < kChanges; ++i) {
      std::string damaged = whole;
      for (auto bytes = 1 + random() % 8; bytes > 0; --bytes)
        damaged[random() % damaged.size()] = static_cast<char>(random());
      const std::string said = refusal(reader, damaged);
      const bool is_refused = said != "not refused";
      refused += is_refused;
      EXPECT_TRUE(!is_refused || said.size() > 20) << said;
    }
    EXPECT_GT(refused, kChanges / 2) << reader.file;
  }
}

}  // namespace
}  // namespace wiimote_tracker
