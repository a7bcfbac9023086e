// rig.yaml: damaged, foreign and unusual files are refused.
#include "refusal_of.h"
#include "rig_file_fixture.h"

#include <boost/locale/encoding_utf.hpp>

#include <sys/stat.h>

namespace wiimote_tracker::geometry::test {
namespace {

namespace fs = std::filesystem;

TEST_F(RigFile, IsRefusedWhenCutOffAnywhere) {
  Rig rig = fullRig();
  rig.covariance.resize(0, 0);  // keeps this short
  write(rig);
  // Without the last byte only the line's end is missing.
  for (std::size_t size = 0; size + 1 < written_.size(); ++size)
    ASSERT_NE("not refused", complaintAbout(written_.substr(0, size))) << size << " bytes";
  EXPECT_EQ("not refused", complaintAbout(written_.substr(0, written_.size() - 1)));
}

TEST_F(RigFile, ListThatEndsWithAColonIsRefused) {
  write(fullRig());
  const std::string complaint =
      complaintAbout(with("square_sides: [2.5,", "square_sides: [2.5:],"));
  EXPECT_NE(std::string::npos, complaint.find("':]'")) << complaint;
}

TEST_F(RigFile, KeyWithoutAValueIsNotTheWordNull) {
  write(fullRig());
  const std::string complaint =
      complaintAbout(with("name: \"" + fullRig().zones[0].name + "\"", "name:"));
  EXPECT_NE(std::string::npos, complaint.find("zones[0]/name has no value")) << complaint;
}

TEST_F(RigFile, ThatCouldNotBeReadIsNotWritten) {
  write(fullRig());
  const auto refusal = [&](const Rig& rig) { return refusalOf([&] { writeRigFile(rig, path_); }); };
  Rig rig = fullRig();
  rig.zones[0].name = "hall:]";
  EXPECT_NE(std::string::npos, refusal(rig).find("':]'")) << refusal(rig);
  rig = fullRig();
  rig.verdict.assign(33000000, 'a');
  EXPECT_NE(std::string::npos, refusal(rig).find("above 32 MB"));
  EXPECT_EQ(written_, contentOf(path_));
}

TEST_F(RigFile, DamageNeverCrashes) {
  Rig rig = fullRig();
  rig.covariance.resize(0, 0);
  write(rig);
  Random random(43);
  for (int i = 0; i < 1000; ++i) {
    std::string damaged = written_;
    for (int k = 0; k < 3; ++k)
      damaged[static_cast<std::size_t>(random.uniform(0, damaged.size()))] =
          static_cast<char>(random.uniform(0, 256));
    // A digit may have become another one; anything else throws an Error.
    const std::string complaint = complaintAbout(damaged);
    ASSERT_EQ(boost::locale::conv::utf_to_utf<char>(complaint), complaint) << "file " << i;
  }
}

TEST_F(RigFile, RefusalIsUtf8AlsoWhereItQuotesTheFile) {
  write(fullRig());
  const std::string complaint = complaintAbout(with("version: 1", "version: \xE9"));
  EXPECT_NE(std::string::npos, complaint.find("version is \xEF\xBF\xBD, but")) << complaint;
}

TEST_F(RigFile, MissingOrUnreadableIsNamed) {
  EXPECT_NE(std::string::npos, complaint(path_).find(path_));
  EXPECT_NE(std::string::npos, complaint(path_).find("No such file or directory); check its name"));
  EXPECT_NE(std::string::npos, complaint(folder_.string()).find("folder"));
}

TEST_F(RigFile, OnlyRegularFilesOfUsualSizeAreRead) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_NE(std::string::npos, complaint(path_).find("a device or a pipe"));
  EXPECT_NE(std::string::npos, complaint("/dev/zero").find("a device or a pipe"));
  fs::remove(path_);
  put("");
  fs::resize_file(path_, 100000000);
  EXPECT_NE(std::string::npos, complaint(path_).find("100 MB are more than the 32 MB"));
}

TEST_F(RigFile, ForeignFilesAreRefused) {
  for (const std::string content :
       {"", "\n", "just text", "[1, 2, 3]", "a: 1\n", "format: something_else\nversion: 1\n",
        "format: [wiimote_tracker_rig]\n", "image_width: 640\nimage_height: 480\n", "\177ELF\2",
        "{{{{", "a: b: c", "*alias", "&a [*a]"}) {
    const std::string complaint = complaintAbout(content);
    EXPECT_NE(std::string::npos, complaint.find(path_)) << "'" << content << "': " << complaint;
  }
}

TEST_F(RigFile, OtherVersionsAreRefused) {
  write(fullRig());
  for (const std::string version : {"2", "0", "1.0", "x", "[1]"}) {
    const std::string complaint = complaintAbout(with("version: 1", "version: " + version));
    EXPECT_NE(std::string::npos, complaint.find("version")) << complaint;
  }
}

TEST_F(RigFile, FaultsAreNamedByKey) {
  write(fullRig());
  const auto names = [&](const std::string& from, const std::string& to, const std::string& key) {
    const std::string complaint = complaintAbout(with(from, to));
    EXPECT_NE(std::string::npos, complaint.find(path_)) << complaint;
    EXPECT_NE(std::string::npos, complaint.find(key)) << complaint;
  };
  names("virtual_hfov:", "virtual_hfof:", "virtual_hfov");
  names("led_height:", "another: 1\nled_height:", "another");
  names("led_height:", "led_height: 1\nled_height:", "led_height is there twice");
  names("image_width: ", "image_width: wide", "camera_0/image_width");
  names("image_width: ", "image_width: 0.", "camera_0/image_width");
  names("image_height: ", "image_height: -", "camera_0/image_height");
  names("plumb_bob", "fisheye", "camera_0/distortion_model");
  names("cols: 5", "cols: 4", "distortion_coefficients/data");
  names("time_offset_rule: one_epoch", "time_offset_rule: sometimes", "time_offset_rule");
  names("ray_model: image_center", "ray_model: other", "ray_model");
  names("frame_id: \"world\"", "frame_id: \"map\"", "frame_id");
  names("child_frame_id: \"camera_0", "child_frame_id: \"camera_9", "child_frame_id");
  names("camera_name: camera_0", "camera_name: camera_9", "camera_name");
  names("[camera_0, camera_1]", "[camera_0]", "camera_1");
  names("[camera_0, camera_1]", "[camera_0, camera_1, camera_2]", "camera_2");
  names("[camera_0, camera_1]", "[camera_0, camera_1, camera_1]", "two cameras");
  names("  camera_1:\n", "  camera_0:\n", "camera_0 is there twice");
  names("inliers: 119", "inliers: -1", "inliers");
  names("inliers: 119", "inliers: 4294967296", "inliers");
  names("complete: true", "complete: false", "complete");
  for (const char* time : {"-1.0", "5e9", "1e18", ".nan"})
    names("solved_at: 1766188800.1234567", std::string("solved_at: ") + time + "  # ", "solved_at");
  names("        w: ", "        w: 7", "rotation");
}

TEST_F(RigFile, AFileThatWasCutOffIsToBeRestoredFromItsBackup) {
  write(fullRig());
  const std::string cut = written_.substr(0, written_.find("  camera_1:"));
  EXPECT_NE(std::string::npos, complaintAbout(cut).find("ends too early")) << complaintAbout(cut);
  EXPECT_NE(std::string::npos, complaintAbout(cut).find("restore it from its backup"));
  std::ofstream(path_ + ".bak") << written_;
  EXPECT_NE(std::string::npos, complaintAbout(cut).find("restore it from " + path_ + ".bak"));
  fs::remove(path_ + ".bak");
}

TEST_F(RigFile, ValuesThatAreNoNumbersAreRefused) {
  Rig rig = fullRig();
  rig.cameras[0].camera.intrinsics.fx = 1234.5;
  rig.cameras[0].camera.world_from_camera.translation().x() = 4321.5;
  write(rig);
  EXPECT_NE(std::string::npos, complaintAbout(with("1234.5", ".nan")).find("fx"));
  EXPECT_NE(std::string::npos, complaintAbout(with("4321.5", ".nan")).find("camera_0"));
  EXPECT_NE(std::string::npos, complaintAbout(with("4321.5", ".inf")).find("camera_0"));
  EXPECT_NE(std::string::npos, complaintAbout(with("4321.5", "")).find("translation/x"));
}

}  // namespace
}  // namespace wiimote_tracker::geometry::test
