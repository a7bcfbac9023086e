#include "scenarios.h"

#include "clock.h"
#include "kernel.h"
#include "recovery.h"
#include "streaming.h"
#include "transport/transport.h"

#include <wiimote_tracker_msgs/text.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

namespace wiimote_tracker::real_kernel {
namespace {

using Bytes = PluggedRemote::Bytes;
using Model = PluggedRemote::Model;
using State = wiimote::Link::State;

/// The first `count` bytes.
std::string hex(const Bytes& bytes, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < std::min(count, bytes.size()); ++i)
    text += format("%02x", static_cast<unsigned>(bytes[i]));
  return text;
}

/// The kernel's reports to a remote without extension during setup: the first seven bytes of each
/// in the order of first appearance, without the motor's bit.
void kernelTraffic(Checks& checks) {
  const double plugged = now();
  Scene scene;
  const PluggedRemote remote(kAddress, scene);
  sleepFor(2.0);
  std::vector<std::string> said;
  std::map<std::string, int> times;
  for (const PluggedRemote::Output& output : remote.outputs(plugged)) {
    const std::string text = hex(output.report, 7);
    if (times[text]++ == 0)
      said.push_back(text);
  }
  const std::vector<std::string> expected{
      "1500",            // status
      "120030",          // after each status
      "1110",            // LED 1
      "1604a400f00155",  // is there an extension?
      "1604a600f00155",  // is there a Motion Plus?
      "1704a600fa0006", "1704a400fa0006",
  };
  // The kernel's workers may swap neighbouring reports.
  checks.check("the kernel sets the virtual remote up as it does a real one",
               std::set<std::string>(said.begin(), said.end()) ==
                   std::set<std::string>(expected.begin(), expected.end()),
               joined(said, " "));
  checks.check("the kernel sets its mode after each status", times["120030"] == times["1500"],
               count(static_cast<std::size_t>(times["1500"]), "status requests"));
  checks.check("hid-wiimote is bound", kernelDriverOf(kAddress) == "wiimote",
               kernelDriverOf(kAddress));
  checks.check("there is a hidraw node", !hidrawOf(kAddress).empty(), hidrawOf(kAddress));
  for (const char* name :
       {"Nintendo Wii Remote", "Nintendo Wii Remote Accelerometer", "Nintendo Wii Remote IR"}) {
    checks.check(std::string("there is the input device ") + name,
                 !inputNodeOf(kAddress, name).empty(), inputNodeOf(kAddress, name));
  }
  const std::string charge = readLine(batteryFileOf(kAddress));
  checks.check("the kernel knows the battery", charge == "62", charge + " %, of raw 0xa0");
  checks.check("LED 1 is on", remote.leds() == 1, std::to_string(remote.leds()));
  const double quiet = now();
  checks.check("the kernel looks for a Motion Plus every 4 s",
               waitFor(
                   [&] {
                     return remote.got({0x16, 0x04, 0xa6, 0x00, 0xf0}, quiet);
                   },
                   4.5));
}

void plug(Checks& checks) {
  Scene scene;
  const RunningDriver driver("", scene, checks.images);
  const bool says_so = waitFor([&] { return !driver.link().error.empty(); }, kTimeout);
  checks.check("without a remote the driver searches and says so",
               says_so && driver.link().state == State::kSearching, driver.link().error);
  std::unique_ptr<PluggedRemote> remote;
  const double since = now();
  remote = std::make_unique<PluggedRemote>(kAddress, scene);
  const bool streams = driver.waitForState(State::kStreaming, kTimeout);
  const wiimote::Link link = driver.link();
  checks.check("a remote that is plugged in streams", streams, "after " + seconds(now() - since));
  checks.check("it is known by its Bluetooth address", link.remote.identity == kAddress,
               link.remote.identity);
  checks.check("it is found at its hidraw node", link.remote.description == hidrawOf(kAddress),
               link.remote.description);
  checks.check("the kernel's driver beside ours is seen", link.remote.kernel_driver == "wiimote",
               link.remote.kernel_driver);
  checks.check("the calibration of its accelerometer is read", link.accelerometer_calibrated);
  checks.recovers("the stream is up to speed", driver, [] {});
}

void stream(Checks& checks) {
  const Streaming streaming(checks);
  const double begin = now();
  checks.streams("", streaming.driver, 20.0);
  checks.check("the kernel was at work meanwhile",
               streaming.remote.got({0x16, 0x04, 0xa6, 0x00, 0xf0}, begin));
}

void unplug(Checks& checks) {
  Streaming streaming(checks);
  const double since = now();
  streaming.remote.unplug();
  const bool seen = streaming.driver.waitForState(State::kSearching, 1.0);
  checks.check("the driver sees that the remote is gone", seen,
               "after " + seconds(now() - since) + ": " + streaming.driver.link().error);
  sleepFor(3.0);
  checks.check(
      "the driver goes on searching",
      streaming.driver.link().state == State::kSearching && !streaming.driver.link().error.empty(),
      streaming.driver.link().error);
}

void replug(Checks& checks) {
  Streaming streaming(checks);
  for (const double away : {0.0, 0.1, 0.7, 1.9, 3.1, 5.3, 10.0, 30.0}) {
    const std::uint32_t epoch = streaming.driver.link().clock_epoch;
    streaming.remote.unplug();
    sleepFor(away);
    const std::string name = "away for " + seconds(away);
    checks.recovers(name, streaming.driver, [&] { streaming.remote.plug(); });
    checks.check(name + ": a new clock epoch", streaming.driver.link().clock_epoch == epoch + 1,
                 std::to_string(streaming.driver.link().clock_epoch));
  }
}

void fourAtOnce(Checks& checks) {
  // Each remote has its own scene, which exposes a driver at the wrong remote.
  std::deque<Scene> scenes;
  std::deque<RunningDriver> drivers;
  std::deque<PluggedRemote> remotes;
  for (int i = 1; i <= 4; ++i) {
    scenes.emplace_back(i);
    drivers.emplace_back(addressOf(i), scenes.back(), checks.images);
  }
  // In another order than the drivers.
  for (const int i : {3, 1, 4, 2})
    remotes.emplace_back(addressOf(i), scenes[static_cast<std::size_t>(i - 1)],
                         i == 4 ? Model::kRemotePlus : Model::kRemote);
  for (const RunningDriver& driver : drivers)
    driver.waitForState(State::kStreaming, kTimeout);
  for (int i = 1; i <= 4; ++i)
    checks.recovers("remote " + std::to_string(i) + " streams to its driver", drivers[i - 1],
                    [] {});

  checks.streamForLong(drivers);

  // They come back in another order, so at other nodes.
  std::vector<std::string> before;
  for (int i = 1; i <= 4; ++i)
    before.push_back(hidrawOf(addressOf(i)));
  for (PluggedRemote& remote : remotes)
    remote.unplug();
  sleepFor(0.5);
  const double since = now();
  for (auto remote = remotes.rbegin(); remote != remotes.rend(); ++remote)
    remote->plug();
  bool moved = false;
  for (int i = 1; i <= 4; ++i) {
    waitFor([&] { return !hidrawOf(addressOf(i)).empty(); }, kTimeout);
    moved = moved || hidrawOf(addressOf(i)) != before[static_cast<std::size_t>(i - 1)];
  }
  checks.check("plugged in again, they are at other nodes", moved);
  for (int i = 1; i <= 4; ++i)
    checks.recoversFrom("remote " + std::to_string(i) + " is found again", drivers[i - 1], since);
}

void ignoreSpecialDrivers(Checks& checks) {
  const double begin = now();
  Streaming streaming(checks);
  checks.check("hid-generic is bound",
               streaming.driver.link().remote.kernel_driver == "hid-generic",
               streaming.driver.link().remote.kernel_driver);
  sleepFor(5.0);
  checks.check("the kernel says nothing to the remote",
               !streaming.remote.got({0x12, 0x00, 0x30}, begin) &&
                   !streaming.remote.got({0x16, 0x04, 0xa6}, begin));
  checks.recovers("the stream is up to speed", streaming.driver, [] {});
  streaming.remote.unplug();
  sleepFor(0.3);
  checks.recovers("plugged in again", streaming.driver, [&] { streaming.remote.plug(); });
}

/// Settings that the driver's own user changes while it streams.
void inTheStream(Checks& checks) {
  Streaming streaming(checks);
  const PluggedRemote& remote = streaming.remote;
  const wiimote::Link before = streaming.driver.link();
  double since = now();
  checks.recovers("sensitivity changed", streaming.driver, [&] {
    streaming.driver.command(
        [](wiimote::Wiimote& wiimote) { wiimote.setSensitivity(*protocol::irSensitivity("max")); });
  });
  const double pause = longestPause(streaming.driver.images(), since, now());
  checks.check("images pause for no longer than 0.2 s", pause <= 0.2, seconds(pause));
  checks.check("it is in the camera",
               remote.got({0x16, 0x04, 0xb0, 0x00, 0x1a, 2, 0x40, 0}, since));
  const wiimote::Link after = streaming.driver.link();
  checks.check("the clock epoch is the same, and nothing had to be restored",
               after.clock_epoch == before.clock_epoch && after.restorations == before.restorations,
               after.last_restoration);

  // The kernel writes every 4 s at least, and each time without the motor.
  streaming.driver.command([](wiimote::Wiimote& wiimote) { wiimote.setRumble(true); });
  checks.check("the motor runs", waitFor([&] { return remote.rumble(); }, 1.0));
  since = now();
  double last_on = since;
  double longest_off = 0.0;
  for (; now() < since + 9.0; sleepFor(0.002)) {
    if (remote.rumble())
      last_on = now();
    longest_off = std::max(longest_off, now() - last_on);
  }
  checks.check("the kernel was at work meanwhile",
               remote.got({0x16, 0x04, 0xa6, 0x00, 0xf0}, since));
  checks.check("the motor never stands still for 0.2 s", longest_off < 0.2, seconds(longest_off));
  streaming.driver.command([](wiimote::Wiimote& wiimote) { wiimote.setRumble(false); });
  checks.check("told so, it stands still", waitFor([&] { return !remote.rumble(); }, 1.0));
  checks.recovers("the stream is up to speed", streaming.driver, [] {});
}

void taken(Checks& checks) {
  Streaming streaming(checks);
  const RunningDriver second(kAddress, streaming.scene, checks.images);
  const bool told = waitFor([&] { return !second.link().error.empty(); }, kTimeout);
  checks.check("a second driver is told that the remote is taken",
               told && second.link().state == State::kSearching, second.link().error);
  sleepFor(3.0);
  checks.check("and gets no image", second.images().empty());
  checks.recovers("the first one streams on", streaming.driver, [] {});
}

/// Opens the remote as an ordinary user, in a child process. @returns what open() says; empty when
/// it succeeds.
std::string openAsNobody() {
  constexpr uid_t kNobody = 65534;
  int ends[2];
  if (::pipe(ends) != 0)
    throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    std::string said = "the user could not be changed";
    if (::setgid(kNobody) == 0 && ::setuid(kNobody) == 0) {
      try {
        transport::open(transport::parseDeviceName(""));
        said = "opened";
      } catch (const transport::PermissionDenied& e) {
        said = std::string("denied: ") + e.what();
      } catch (const std::exception& e) {
        said = std::string("another error: ") + e.what();
      }
    }
    const ssize_t written = ::write(ends[1], said.data(), said.size());
    ::_exit(written == static_cast<ssize_t>(said.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string said;
  char buffer[256];
  for (ssize_t size = 0; (size = ::read(ends[0], buffer, sizeof(buffer))) > 0;)
    said.append(buffer, static_cast<std::size_t>(size));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return said;
}

void nonRoot(Checks& checks) {
  Scene scene;
  const PluggedRemote remote(kAddress, scene);
  waitFor([] { return !hidrawOf(kAddress).empty(); }, kTimeout);
  sleepFor(kSetUpTime);
  const std::string said = openAsNobody();
  checks.check("an ordinary user is denied the remote", said.compare(0, 7, "denied:") == 0, said);
  checks.check("and told of the udev rule",
               said.find("60-wiimote-tracker.rules") != std::string::npos &&
                   said.find("/etc/udev/rules.d") != std::string::npos);
  ::chmod(hidrawOf(kAddress).c_str(), 0666);  // as the udev rule does for members of a group
  const std::string again = openAsNobody();
  checks.check("with access it opens", again == "opened", again);
}

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all{
      {"kernel_traffic", kernelTraffic},
      {"plug", plug},
      {"stream", stream},
      {"unplug", unplug},
      {"replug", replug},
      {"four_at_once", fourAtOnce},
      {"ignore_special_drivers", ignoreSpecialDrivers},
      {"battery", battery},
      {"evdev", evdev},
      {"extension", extension},
      {"another_program", anotherProgram},
      {"other_formats", otherFormats},
      {"in_the_stream", inTheStream},
      {"leds", leds},
      {"rebind", rebind},
      {"taken", taken},
      {"non_root", nonRoot},
      {"mute_remote", muteRemote},
      {"pair", pairScenario, "bluetooth"},
      {"pair_refused", pairRefused, "bluetooth"},
      {"two_adapters", twoAdapters, "bluetooth"},
      {"hidp", overHidp, "bluetooth"},
      {"userspace_hid", overUserspaceHid, "bluetooth"},
      {"xwiimote_client", xwiimoteClient, "clients"},
      {"cwiid_client", cwiidClient, "clients"},
  };
  return all;
}

}  // namespace wiimote_tracker::real_kernel
