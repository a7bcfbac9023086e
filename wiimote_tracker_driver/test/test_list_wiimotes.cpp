// list_wiimotes: a computer with a simulated /sys and /etc, and the list of cameras.
#include "contains.h"
#include "refusal_of.h"
#include "temporary_folder.h"
#include "tools/list_wiimotes/camera_list.h"
#include "tools/list_wiimotes/host.h"
#include "tools/list_wiimotes/listing.h"
#include "tools/list_wiimotes/replacement.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {
namespace {

namespace fs = std::filesystem;

/// Number of sentences that contain the part.
int count(const std::vector<std::string>& sentences, const std::string& part) {
  int found = 0;
  for (const std::string& sentence : sentences)
    found += contains(sentence, part) ? 1 : 0;
  return found;
}

// A remote as Linux 6.1 shows it.
void plug(const TemporaryFolder& root,
          int number,
          const std::string& product,
          const std::string& driver,
          const std::string& hidraw,
          const std::string& adapter = "00:1A:7D:DA:71:13") {
  const std::string folder =
      "sys/bus/hid/devices/0005:057E:" + product + ".000" + std::to_string(number) + "/";
  root.write(folder + "uevent", (driver.empty() ? "" : "DRIVER=" + driver + "\n") +
                                    "HID_ID=0005:0000057E:0000" + product +
                                    "\nHID_NAME=Nintendo RVL-CNT-01\nHID_PHYS=" + adapter +
                                    "\nHID_UNIQ=00:1F:32:00:00:0" + std::to_string(number) + "\n");
  if (!hidraw.empty())
    root.write(folder + "hidraw/" + hidraw + "/dev", "241:0\n");
}

TEST(Host, RemotesAreFoundWithAllThatTheKernelReports) {
  const TemporaryFolder root;
  plug(root, 1, "0306", "wiimote", "hidraw10");
  plug(root, 2, "0330", "hid-generic", "hidraw9");
  root.write("sys/bus/hid/devices/0003:046D:C31C.0003/uevent",
             "DRIVER=hid-generic\nHID_ID=0003:0000046D:0000C31C\nHID_NAME=Keyboard\n");
  root.write("sys/bus/hid/devices/0003:046D:C31C.0003/hidraw/hidraw0/dev", "");
  root.write("sys/bus/hid/devices/0005:057E:0330.0004/uevent",
             "DRIVER=wiimote\nHID_ID=0005:0000057E:00000330\nHID_NAME=Nintendo RVL-CNT-01-UC\n");
  root.write("sys/bus/hid/devices/0005:057E:0306.0005/uevent",
             "DRIVER=wiimote\nHID_ID=0005:0000057E:00000306\nHID_NAME=Nintendo RVL-WBC-01\n");
  const Host host = readHost(root.path());
  ASSERT_EQ(2u, host.remotes.size());
  EXPECT_EQ("/dev/hidraw9", host.remotes[0].path);
  EXPECT_EQ("00:1f:32:00:00:02", host.remotes[0].address);
  EXPECT_EQ("00:1a:7d:da:71:13", host.remotes[0].adapter);
  EXPECT_EQ("hid-generic", host.remotes[0].kernel_driver);
  EXPECT_TRUE(contains(modelOf(host.remotes[0]), "-TR"));
  EXPECT_EQ("/dev/hidraw10", host.remotes[1].path);
  EXPECT_FALSE(contains(modelOf(host.remotes[1]), "-TR"));
  EXPECT_TRUE(problems(host.remotes[0]).empty());
  EXPECT_TRUE(notes(host.remotes[0]).empty());
  EXPECT_TRUE(problems(host.remotes[1]).empty());
  EXPECT_EQ(1, count(notes(host.remotes[1]), "hid-wiimote shares"));
}

TEST(Host, RemoteWithoutKernelDriverIsFound) {
  const TemporaryFolder root;
  plug(root, 1, "0306", "", "");
  const Host host = readHost(root.path());
  ASSERT_EQ(1u, host.remotes.size());
  EXPECT_EQ("", host.remotes[0].path);
  EXPECT_EQ(1, count(problems(host.remotes[0]), "modprobe hid-wiimote"));
}

// On USB, HID_UNIQ is the serial number of the converter, the same for all of its remotes.
TEST(Host, ConverterHidesTheAddress) {
  const TemporaryFolder root;
  root.write("sys/bus/hid/devices/0003:057E:0306.0001/uevent",
             "DRIVER=hid-generic\nHID_ID=0003:0000057E:00000306\nHID_NAME=Mayflash\n"
             "HID_PHYS=usb-0000:00:14.0-2/input0\nHID_UNIQ=NJ_BAR_1\n");
  root.write("sys/bus/hid/devices/0003:057E:0306.0001/hidraw/hidraw1/dev", "");
  const Host host = readHost(root.path());
  ASSERT_EQ(1u, host.remotes.size());
  EXPECT_EQ("", host.remotes[0].address);
  EXPECT_EQ("", host.remotes[0].adapter);
  EXPECT_EQ(1, count(problems(host.remotes[0]), "does not reveal its Bluetooth address"));
}

TEST(Host, EachProblemOfTheComputerHasASentence) {
  const TemporaryFolder root;
  fs::create_directories(root / "sys");
  EXPECT_EQ(1, count(problems(readHost(root.path())), "no Bluetooth adapter"));
  EXPECT_EQ(1, count(problems(readHost(root.path())), "no udev rule"));

  root.write("sys/class/bluetooth/hci0/address", "");
  root.write("sys/class/rfkill/rfkill1/name", "hci0\n");
  root.write("sys/class/rfkill/rfkill1/soft", "1\n");
  root.write("sys/class/rfkill/rfkill1/hard", "0\n");
  EXPECT_EQ(0, count(problems(readHost(root.path())), "no Bluetooth adapter"));
  EXPECT_EQ(1, count(problems(readHost(root.path())), "rfkill unblock"));
  root.write("sys/class/rfkill/rfkill1/hard", "1\n");
  EXPECT_EQ(1, count(problems(readHost(root.path())), "switched off by hardware"));
  root.write("sys/class/rfkill/rfkill1/hard", "0\n");
  root.write("sys/class/rfkill/rfkill1/soft", "0\n");

  // A connection is no adapter, and a rule in a comment is none.
  root.write("sys/class/bluetooth/hci0:256/address", "");
  EXPECT_EQ(1u, readHost(root.path()).adapters.size());
  root.write("etc/udev/rules.d/1.rules", "# KERNEL==\"hidraw*\", KERNELS==\"*057E:0306*\"\n");
  EXPECT_EQ(1, count(problems(readHost(root.path())), "no udev rule"));
  fs::copy_file(std::string(UDEV_DIRECTORY) + "/60-wiimote-tracker.rules",
                root / "etc/udev/rules.d/60-wiimote-tracker.rules");
  EXPECT_TRUE(problems(readHost(root.path())).empty());

  root.write("etc/bluetooth/input.conf", "[General]\n#ClassicBondedOnly=true\n");
  EXPECT_TRUE(problems(readHost(root.path())).empty());
  root.write("etc/bluetooth/input.conf", "[General]\nClassicBondedOnly = true\n");
  EXPECT_EQ(1, count(problems(readHost(root.path())), "ClassicBondedOnly"));
  root.write("etc/bluetooth/input.conf", "[General]\nClassicBondedOnly=false\n");
  EXPECT_TRUE(problems(readHost(root.path())).empty());
}

TEST(Host, SevenRemotesFillAnAdapter) {
  const TemporaryFolder root;
  for (int i = 1; i <= 6; ++i)
    plug(root, i, "0306", "hid-generic", "hidraw" + std::to_string(i));
  plug(root, 8, "0306", "hid-generic", "hidraw8", "00:1A:7D:DA:71:14");
  EXPECT_EQ(0, count(problems(readHost(root.path())), "the most it can take"));
  plug(root, 7, "0306", "hid-generic", "hidraw7");
  EXPECT_EQ(1, count(problems(readHost(root.path())), "00:1a:7d:da:71:13 has 7 remotes"));
}

constexpr char kList[] =
    "# Mine.\ncameras:\n  door: \"00:1F:32:00:00:01\"  # above the door\n"
    "  wiimote_2: /dev/hidraw3\n\n# The end.\n";

TEST(CameraList, KeepsNamesCommentsAndOrder) {
  CameraList list(kList);
  EXPECT_EQ(kList, list.text());
  ASSERT_EQ(2u, list.cameras().size());
  EXPECT_EQ("door", list.cameras()[0].name);
  EXPECT_EQ("/dev/hidraw3", list.cameras()[1].device);
  EXPECT_EQ("door", list.nameOf("00:1f:32:00:00:01"));
  EXPECT_EQ("", list.nameOf("00:1f:32:00:00:09"));
  EXPECT_EQ("wiimote_1", list.add("00:1f:32:00:00:05"));
  EXPECT_EQ("wiimote_3", list.add("00:1f:32:00:00:06"));
  list.replace("door", "00:1f:32:00:00:07");
  EXPECT_EQ(
      "# Mine.\ncameras:\n  door: \"00:1f:32:00:00:07\"  # above the door\n"
      "  wiimote_2: /dev/hidraw3\n  wiimote_1: \"00:1f:32:00:00:05\"\n"
      "  wiimote_3: \"00:1f:32:00:00:06\"\n\n# The end.\n",
      list.text());
  EXPECT_TRUE(contains(refusalOf([&] { list.replace("window", "x"); }), "no camera 'window'"));
  EXPECT_TRUE(contains(refusalOf([&] { list.replace("", "x"); }), "no camera ''"));
}

TEST(CameraList, ANewOneCanBeReadBack) {
  CameraList list;
  list.add("00:1f:32:00:00:01");
  EXPECT_EQ("wiimote_1", CameraList(list.text()).nameOf("00:1F:32:00:00:01"));
}

TEST(CameraList, AddsNothingBehindItsEnd) {
  for (const char* end : {"...\n", "---\ncameras:\n  window: \"00:1f:32:00:00:02\"\n"}) {
    CameraList list(std::string("cameras:\n  door: \"00:1f:32:00:00:01\"\n") + end);
    EXPECT_TRUE(contains(refusalOf([&] { list.add("00:1f:32:00:00:03"); }), "remove it")) << end;
  }
}

// The list of four cameras that wiimote_tracker_bringup ships.
TEST(CameraList, TheExampleCanBeRead) {
  const CameraList list(
      "# Replace these addresses by your own.\ncameras:\n  wiimote_1: \"00:1f:32:00:00:01\"\n"
      "  wiimote_2: \"00:1f:32:00:00:02\"\n  wiimote_3: \"00:1f:32:00:00:03\"\n"
      "  wiimote_4: \"00:1f:32:00:00:04\"\n");
  EXPECT_EQ("wiimote_4", list.nameOf("00:1f:32:00:00:04"));
}

TEST(CameraList, ACameraMayHaveDriverParameters) {
  const std::string text =
      "cameras:\n  door:\n    driver:\n      identity: inside\n      ir_mode: full\n"
      "    identity: \"00:1f:32:00:00:01\"  # this\n  wiimote_1: \"00:1f:32:00:00:02\"\n"
      "  window:\n    identity: '00:1f:32:00:00:03'\n    driver: {ir_mode: basic}\n";
  CameraList list(text);
  EXPECT_EQ(text, list.text());
  EXPECT_EQ("door", list.nameOf("00:1f:32:00:00:01"));
  EXPECT_EQ("window", list.nameOf("00:1f:32:00:00:03"));
  EXPECT_EQ(3u, list.cameras().size());
  list.replace("door", "00:1f:32:00:00:07");
  EXPECT_EQ("wiimote_2", list.add("00:1f:32:00:00:08"));
  EXPECT_EQ(
      "cameras:\n  door:\n    driver:\n      identity: inside\n      ir_mode: full\n"
      "    identity: \"00:1f:32:00:00:07\"  # this\n  wiimote_1: \"00:1f:32:00:00:02\"\n"
      "  window:\n    identity: '00:1f:32:00:00:03'\n    driver: {ir_mode: basic}\n"
      "  wiimote_2: \"00:1f:32:00:00:08\"\n",
      list.text());
}

TEST(CameraList, ItMayDiscoverOtherRemotes) {
  CameraList list("discover: true  # whatever is there\n\ncameras:\n");
  EXPECT_EQ("wiimote_1", list.add("00:1f:32:00:00:01"));
  EXPECT_EQ("discover: true  # whatever is there\n\ncameras:\n  wiimote_1: \"00:1f:32:00:00:01\"\n",
            list.text());
}

TEST(CameraList, RefusesTextsThatItCannotPreserve) {
  for (const char* text :
       {"", "# nothing\n", "wiimote_1: \"00:1f:32:00:00:01\"\n", "cameras: {a: \"x\"}\n",
        "cameras:\n  - a\n", "cameras:\n  a:\n    driver: \"x\"\n", "cameras:\n  a:\n",
        "cameras:\n  1: \"x\"\n", "cameras:\n  a b: \"x\"\n", "cameras:\n  a: \"x\"\n  a: \"y\"\n",
        "cameras:\n  a: \"x\"\nother:\n", "discover: perhaps\ncameras:\n",
        "cameras:\n  a: 11:22:33:44:55:06\n", "cameras:\n  a:\n    identity: \"x\"\n    drivr:\n",
        "cameras:\n  a:\n    identity: \"x\"\n    driver: max\n", "cameras:\n  a: \"x\n",
        "cameras:\n  a: {b: c}\n"}) {
    EXPECT_NE("not refused", refusalOf([&] { CameraList list{std::string(text)}; })) << text;
  }
  EXPECT_TRUE(contains(refusalOf([] { CameraList list(std::string("cameras:\n  - a\n")); }),
                       "line 2 is '  - a'"));
}

TEST(CameraList, ProblemsOfDevices) {
  EXPECT_TRUE(problems(CameraList(std::string(kList))).empty());
  const auto found = problems(
      CameraList(std::string("cameras:\n  a: \"00:1f:32:00:00:0a\"\n  b: \"00:1F:32:00:00:0A\"\n"
                             "  c: \"00-1f-32-00-00-01\"\n  d: \"/dev/hidraw1\"\n"
                             "  e: \"replay:e.wiirec\"\n")));
  EXPECT_EQ(2u, found.size());
  EXPECT_EQ(1, count(found, "camera b has the device 00:1F:32:00:00:0A, and so has camera a"));
  EXPECT_EQ(1, count(found, "camera c has the device 00-1f-32-00-00-01: give a Bluetooth address"));
}

TEST(CameraList, AZeroByteIsNotTheEndOfTheFile) {
  const TemporaryFolder folder;
  folder.write("cameras.yaml", std::string("cameras:\n# ") + '\0' + "\n  door: \"x\"\n");
  EXPECT_EQ("door", readCameraList(folder / "cameras.yaml").nameOf("x"));
}

TEST(CameraList, WritingKeepsTheOldFile) {
  const TemporaryFolder folder;
  const std::string path = folder / "cameras.yaml";
  EXPECT_TRUE(contains(refusalOf([&] { readCameraList(path); }), "cannot be read"));
  EXPECT_TRUE(contains(refusalOf([&] { readCameraList(folder / ""); }), "cannot be read"));
  folder.write("empty.yaml", "");
  EXPECT_TRUE(
      contains(refusalOf([&] { readCameraList(folder / "empty.yaml"); }), "no line \"cameras:\""));
  writeCameraList(CameraList(kList), path);
  EXPECT_FALSE(fs::exists(path + ".bak"));
  CameraList list = readCameraList(path);
  list.add("00:1f:32:00:00:05");
  writeCameraList(list, path);
  EXPECT_EQ(kList, folder.read("cameras.yaml.bak"));
  EXPECT_EQ(list.text(), folder.read("cameras.yaml"));
  EXPECT_FALSE(fs::exists(path + ".new"));
  EXPECT_NE("not refused",
            refusalOf([&] { writeCameraList(list, folder / "nowhere/cameras.yaml"); }));
}

TEST(CameraList, ALinkStaysALink) {
  const TemporaryFolder folder;
  folder.write("real/cameras.yaml", kList);
  fs::create_symlink(folder / "real/cameras.yaml", folder / "cameras.yaml");
  writeCameraList(CameraList(), folder / "cameras.yaml");
  EXPECT_TRUE(fs::is_symlink(folder / "cameras.yaml"));
  EXPECT_EQ(CameraList().text(), folder.read("real/cameras.yaml"));
}

class Replacing : public testing::Test {
 protected:
  Replacing() {
    folder_.write("cameras.yaml", kList);
    folder_.write("camera_info/door.yaml", "of the old lens");
    folder_.write("camera_info/wiimote_2.yaml", "of another lens");
  }
  std::string replace(const std::string& camera, const std::string& address) {
    return replaceRemote(
        {camera, address, folder_ / "cameras.yaml", folder_ / "camera_info", "2020-01-02"});
  }
  const TemporaryFolder folder_;
};

TEST_F(Replacing, KeepsTheNameAndSetsTheCalibrationAside) {
  const std::string done = replace("door", "00:1F:32:AA:BB:CC");
  EXPECT_TRUE(contains(done, "calibrate"));
  EXPECT_EQ("door", readCameraList(folder_ / "cameras.yaml").nameOf("00:1f:32:aa:bb:cc"));
  EXPECT_FALSE(fs::exists(folder_ / "camera_info/door.yaml"));
  EXPECT_EQ("of the old lens", folder_.read("camera_info/door.yaml.replaced-2020-01-02"));
  EXPECT_EQ("of another lens", folder_.read("camera_info/wiimote_2.yaml"));
  EXPECT_EQ(kList, folder_.read("cameras.yaml.bak"));
}

TEST_F(Replacing, TwiceADayKeepsBothCalibrations) {
  replace("door", "00:1f:32:aa:bb:cc");
  folder_.write("camera_info/door.yaml", "of the second lens");
  replace("door", "00:1f:32:aa:bb:dd");
  EXPECT_EQ("of the old lens", folder_.read("camera_info/door.yaml.replaced-2020-01-02"));
  EXPECT_EQ("of the second lens", folder_.read("camera_info/door.yaml.replaced-2020-01-02-2"));
}

TEST_F(Replacing, WorksWithoutACalibration) {
  fs::remove_all(folder_ / "camera_info");
  replace("door", "00:1f:32:aa:bb:cc");
  EXPECT_EQ("door", readCameraList(folder_ / "cameras.yaml").nameOf("00:1f:32:aa:bb:cc"));
}

TEST_F(Replacing, InvalidArgumentsChangeNothing) {
  EXPECT_TRUE(
      contains(refusalOf([&] { replace("window", "00:1f:32:aa:bb:cc"); }), "door, wiimote_2"));
  EXPECT_TRUE(contains(refusalOf([&] { replace("door", "hidraw3"); }), "not a Bluetooth address"));
  EXPECT_TRUE(
      contains(refusalOf([&] { replace("door", "/dev/hidraw3"); }), "not a Bluetooth address"));
  EXPECT_TRUE(contains(refusalOf([&] { replace("wiimote_2", "00:1f:32:00:00:01"); }),
                       "is already camera door"));
  EXPECT_EQ(kList, folder_.read("cameras.yaml"));
  EXPECT_TRUE(fs::exists(folder_ / "camera_info/door.yaml"));
}

TEST_F(Replacing, AListThatCannotBeWrittenKeepsTheCalibration) {
  // The new file cannot be made where a folder has its name.
  fs::create_directories(folder_ / "cameras.yaml.new/in_the_way");
  EXPECT_TRUE(
      contains(refusalOf([&] { replace("door", "00:1f:32:aa:bb:cc"); }), "cannot be written"));
  EXPECT_EQ("of the old lens", folder_.read("camera_info/door.yaml"));
}

TEST(Listing, ARemoteIsFoundByItsAddressOrPath) {
  Row bluetooth;
  bluetooth.device = {transport::DeviceName::Kind::kPath, "/dev/hidraw1"};
  bluetooth.text = "00:1f:32:00:00:05";
  Row converter;  // has no address
  converter.device = {transport::DeviceName::Kind::kPath, "/dev/hidraw3"};
  const CameraList list("cameras:\n  door: \"00:1F:32:00:00:05\"\n  wall: /dev/hidraw3\n");
  EXPECT_EQ("door", cameraOf(bluetooth, list));
  EXPECT_EQ("wall", cameraOf(converter, list));
  EXPECT_TRUE(absentOf(list, {bluetooth, converter}).empty());
  ASSERT_EQ(1u, absentOf(list, {converter}).size());
  EXPECT_EQ("door", absentOf(list, {converter})[0].name);
}

}  // namespace
}  // namespace wiimote_tracker::list_wiimotes
