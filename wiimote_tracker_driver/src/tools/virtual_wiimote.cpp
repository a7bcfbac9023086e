// A virtual Wii Remote that sees LEDs move in a circle, for trying a driver without hardware.
#include "transport/transport.h"
#include "virtual_wiimote/uhid.h"
#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {
namespace {

volatile std::sig_atomic_t stop = 0;

void handleSignal(int) {
  stop = 1;
}

struct Arguments {
  std::string socket;
  bool uhid = false;
  bool plus = false;
  std::string address = "00:1f:32:00:00:01";
  int battery = 0xa0;
  int lights = 1;
  std::vector<std::string> faults;  ///< NAME=VALUE.
};

/// In lower case, as Linux has it and as messages promise. @throws BadArguments.
std::string addressOf(const std::string& text) {
  if (const auto address = transport::bluetoothAddress(text))
    return *address;
  throw BadArguments("'" + text + "' is not a Bluetooth address such as 00:1f:32:12:34:56");
}

/// @throws BadArguments.
Faults faultsOf(const Arguments& arguments) {
  Faults faults;
  try {
    for (const std::string& fault : arguments.faults)
      setFault(faults, fault);
  } catch (const std::invalid_argument& e) {
    throw BadArguments(e.what());
  }
  return faults;
}

Device::Options deviceOptions(const Arguments& arguments) {
  Device::Options options;
  options.battery = static_cast<std::uint8_t>(arguments.battery);
  options.motion_plus = arguments.plus;
  // Each address has its own factory calibration.
  std::seed_seq sequence(arguments.address.begin(), arguments.address.end());
  std::uint32_t seed = 0;
  sequence.generate(&seed, &seed + 1);
  options.factory_points = factoryPoints(512.0, 384.0, seed);
  return options;
}

/// `time` [s] since the start.
Senses sense(int lights, double time) {
  constexpr double kTurn = 4.0;      // [s]
  constexpr double kRadius = 250.0;  // [px]
  constexpr double kDistance = 2.0;  // [m]
  constexpr double kTwoPi = 6.283185307179586;
  Senses senses;
  for (int i = 0; i < lights; ++i) {
    const double angle = kTwoPi * (time / kTurn + static_cast<double>(i) / lights);
    Light light;
    light.x = 512.0 + kRadius * std::cos(angle);
    light.y = 384.0 + kRadius * std::sin(angle);
    light.brightness = 1.0 / (kDistance * kDistance);
    senses.lights.push_back(light);
  }
  return senses;
}

/// Prints changes of LEDs and motor. @param name under which drivers open it; printed once the
/// remote behaves as asked.
void run(HostedDevice& remote,
         const std::string& name,
         const Arguments& arguments,
         const Faults& faults) {
  using Clock = std::chrono::steady_clock;
  remote.setFaults(faults);
  std::printf("a virtual Wii Remote, device %s\n", name.c_str());
  int leds_before = 0;
  bool rumble_before = false;
  const Clock::time_point start = Clock::now();
  for (int i = 0; !stop; ++i) {
    std::this_thread::sleep_until(start + i * std::chrono::milliseconds(10));
    remote.sample(sense(arguments.lights, 0.01 * i));
    const int leds = remote.leds();
    if (leds != std::exchange(leds_before, leds))
      std::printf("LEDs: %c %c %c %c\n", leds & 1 ? '1' : '-', leds & 2 ? '2' : '-',
                  leds & 4 ? '3' : '-', leds & 8 ? '4' : '-');
    const bool rumble = remote.rumble();
    if (rumble != std::exchange(rumble_before, rumble))
      std::printf("motor: %s\n", rumble ? "on" : "off");
  }
}

/// @throws BadArguments.
void runFor(const Arguments& arguments) {
  if (arguments.uhid == !arguments.socket.empty())
    throw BadArguments("give either --socket PATH or --uhid");
  const Faults faults = faultsOf(arguments);
  if (!arguments.uhid) {
    Server server(arguments.socket, arguments.address, deviceOptions(arguments));
    run(server, "virtual:" + arguments.socket, arguments, faults);
    return;
  }
  UhidDevice::Options options;
  options.device = deviceOptions(arguments);
  options.model = arguments.plus ? UhidDevice::Model::kRemotePlus : UhidDevice::Model::kRemote;
  UhidDevice device(arguments.address, options);
  run(device, arguments.address, arguments, faults);
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote

int main(int argc, char** argv) {
  using namespace wiimote_tracker::virtual_wiimote;
  Arguments arguments;
  wiimote_tracker::ArgumentParser parser(
      "virtual_wiimote",
      "A virtual Wii Remote: 100 images a second of an LED 2 m away that moves in a circle.");
  parser.option("--socket PATH", &arguments.socket,
                "listen at this socket; drivers open device virtual:PATH");
  parser.flag("--uhid", &arguments.uhid,
              "be a Bluetooth remote of this machine's kernel (needs root and the module uhid)");
  parser.flag("--plus", &arguments.plus, "be an RVL-CNT-01-TR with MotionPlus, not an RVL-CNT-01");
  parser.option("--address ADDRESS", &arguments.address, "Bluetooth address");
  parser.option("--battery N", &arguments.battery, 0, 255, "raw level of the batteries");
  parser.option("--lights N", &arguments.lights, 0, 16, "number of LEDs on the circle");
  parser.option("--fault NAME=VALUE", &arguments.faults, "a fault to simulate; may be repeated");
  return parser.run(argc, argv, [&] {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    std::signal(SIGINT, handleSignal);
    std::signal(SIGTERM, handleSignal);
    arguments.address = addressOf(arguments.address);
    runFor(arguments);
    return 0;
  });
}
