#include "scenarios.h"

#include "air/air.h"
#include "bluez.h"
#include "clock.h"
#include "kernel.h"
#include "process.h"
#include "streaming.h"

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

namespace wiimote_tracker::real_kernel {
namespace {

using State = wiimote::Link::State;

constexpr char kAdapter[] = "00:1a:7d:00:00:01";
constexpr char kSecondAdapter[] = "00:1a:7d:00:00:02";
constexpr double kStart = 20.0;        // [s] For list_wiimotes to end.
constexpr double kPairing = 120.0;     // [s]
constexpr double kLookInterval = 0.3;  // [s] Between looks at the output of `pair`.
constexpr double kConnection = 5.0;    // [s]
constexpr char kRefusedPin[] = "the remote refused the PIN, as it does when 1 and 2 were pressed";

/// A computer with one adapter, and remotes 1 to `count` in the air; the fourth is a -TR.
struct Room {
  explicit Room(int count) {
    for (int i = 1; i <= count; ++i) {
      scenes.emplace_back(i);
      air.addRemote(addressOf(i), scenes.back(), i == 4);
    }
    air.addAdapter(kAdapter);
  }

  std::deque<Scene> scenes;
  Air air;
  Bluez bluez;
};

struct Outcome {
  int status = -1;
  std::string said;
};

/// Runs `pair`, and presses the remote's buttons when asked to.
Outcome pair(Air& air, int remote, Press press, std::vector<std::string> arguments = {}) {
  std::vector<std::string> command{"pair", "--timeout", "30", "--address", addressOf(remote)};
  command.insert(command.end(), arguments.begin(), arguments.end());
  Process program(command);
  Outcome outcome;
  std::size_t heard = 0;
  for (const double end = now() + kPairing; outcome.status < 0 && now() < end;) {
    outcome.status = program.wait(kLookInterval).value_or(-1);
    outcome.said = program.output();
    const std::size_t asked = outcome.said.find("Now press", heard);
    if (asked == std::string::npos)
      continue;
    heard = asked + 1;
    air.press(addressOf(remote), press);
  }
  std::replace(outcome.said.begin(), outcome.said.end(), '\n', ' ');
  return outcome;
}

void checkPaired(Checks& checks, Air& air, int remote) {
  const Outcome outcome = pair(air, remote, Press::kSync);
  checks.check("remote " + std::to_string(remote) + " is paired by SYNC", outcome.status == 0,
               outcome.status == 0 ? "" : outcome.said);
}

bool says(const Outcome& outcome, const std::string& text) {
  return outcome.said.find(text) != std::string::npos;
}

void checkList(Checks& checks, int remotes) {
  Process list({"list_wiimotes"});
  const auto status = list.wait(kStart);
  std::string said = list.output();
  bool all = true;
  for (int i = 1; i <= remotes; ++i)
    all = all && said.find(addressOf(i)) != std::string::npos;
  all = all && said.find(addressOf(remotes + 1)) == std::string::npos;
  std::replace(said.begin(), said.end(), '\n', ' ');
  checks.check("list_wiimotes shows " + std::to_string(remotes) + " free ones",
               status == 0 && all && said.find(kAdapter) != std::string::npos, said);
}

/// Four remotes and their drivers: stream, loss of power, restart of bluetoothd.
void fourInTheAir(Checks& checks, const std::string& kernels_parent) {
  Room room(4);
  std::deque<RunningDriver> drivers;
  for (int i = 1; i <= 4; ++i)
    checkPaired(checks, room.air, i);
  checkList(checks, 4);
  const std::string path = sysfsPathOf(addressOf(1));
  checks.check("reports pass the expected part of the kernel",
               path.find(kernels_parent) != std::string::npos, path);
  for (int i = 1; i <= 4; ++i)
    drivers.emplace_back(addressOf(i), room.scenes[static_cast<std::size_t>(i - 1)], checks.images);
  for (int i = 1; i <= 4; ++i)
    checks.recoversFrom("remote " + std::to_string(i) + " streams", drivers[i - 1], now());
  checks.streamForLong(drivers);

  const auto comes_back = [&](const std::string& name, int remote) {
    const RunningDriver& driver = drivers[remote - 1];
    checks.check(name + ": the driver searches", driver.waitForState(State::kSearching, 3.0),
                 driver.link().error);
    room.air.press(addressOf(remote), Press::kOther);
    waitFor([&] { return !hidrawOf(addressOf(remote)).empty(); }, kConnection);
    checks.recoversFrom(name + ": a button brings remote " + std::to_string(remote) + " back",
                        driver, now());
  };
  room.air.cutPower(addressOf(2));
  comes_back("loss of power", 2);
  checks.recovers("the others stream on", drivers[0], [] {});
  room.bluez.restart();
  for (int i = 1; i <= 4; ++i)
    comes_back("restart of bluetoothd", i);
}

}  // namespace

void pairScenario(Checks& checks) {
  Room room(2);
  checkPaired(checks, room.air, 1);
  checkList(checks, 1);
  const RunningDriver driver(addressOf(1), room.scenes[0], checks.images);
  checks.recoversFrom("it streams", driver, now());

  const Outcome again = pair(room.air, 1, Press::kSync);
  checks.check("paired again: the old pairing is replaced",
               again.status == 0 && says(again, "old pairing, which is now removed"), again.said);
  checks.recoversFrom("and it streams again", driver, now());

  room.air.cutPower(addressOf(1));
  driver.waitForState(State::kSearching, 3.0);
  const Outcome known = pair(room.air, 1, Press::kOther);
  checks.check("a known remote that connects by a button is told from a new one",
               known.status == 0 && says(known, "is known here and has just connected"),
               known.said);
}

void pairRefused(Checks& checks) {
  Room room(2);
  const Outcome refused = pair(room.air, 1, Press::kOneAndTwo);
  checks.check("1+2: the advice is SYNC",
               refused.status == 1 && says(refused, kRefusedPin) && says(refused, "SYNC"),
               refused.said);
  const Outcome none = pair(room.air, 1, Press::kOther);
  checks.check("none found: the advice is batteries, distance and SYNC",
               none.status == 1 && says(none, "no Wii Remote was found in 30 s"), none.said);
  checkPaired(checks, room.air, 2);
}

void twoAdapters(Checks& checks) {
  Room room(2);
  room.air.addAdapter(kSecondAdapter);
  std::vector<std::string> adapters{kAdapter, kSecondAdapter};
  for (int i = 1; i <= 2; ++i) {
    const std::string& adapter = adapters[static_cast<std::size_t>(i - 1)];
    const Outcome outcome = pair(room.air, i, Press::kSync, {"--adapter", adapter});
    checks.check("paired with adapter " + adapter, outcome.status == 0, outcome.said);
    checks.check("it is connected to that one", adapterOf(addressOf(i)) == adapter,
                 adapterOf(addressOf(i)));
  }
}

void overHidp(Checks& checks) {
  // The default depends on the version of BlueZ.
  writeText("/etc/bluetooth/input.conf", "[General]\nUserspaceHID=false\n");
  fourInTheAir(checks, "/bluetooth/");
}

void overUserspaceHid(Checks& checks) {
  writeText("/etc/bluetooth/input.conf", "[General]\nUserspaceHID=true\n");
  fourInTheAir(checks, "/misc/uhid/");
}

}  // namespace wiimote_tracker::real_kernel
