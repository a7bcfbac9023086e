// A Wii Remote that does not exist, before which an LED goes round in a circle: for trying a driver
// without hardware.
#include "wiimote_tracker_driver/virtual_wiimote/server.h"
#include "wiimote_tracker_driver/virtual_wiimote/uhid.h"

#include <getopt.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr char kUsage[] = R"(Usage: virtual_wiimote (--socket PATH | --uhid) [options]

A virtual Wii Remote: 100 images a second of an LED 2 m away that goes round in a circle.

  --socket PATH       listen at this socket; drivers open it as device virtual:PATH
  --uhid              be a Bluetooth remote of this machine's kernel (root; module uhid)
  --plus              be an RVL-CNT-01-TR, with MotionPlus, not an RVL-CNT-01
  --address ADDRESS   Bluetooth address (default 00:1f:32:00:00:01)
  --battery N         raw level of the batteries, 0..255 (default 160)
  --lights N          so many LEDs on the circle, 0..16 (default 1)
  --fault NAME=VALUE  something goes wrong; may be given several times
  --help
)";

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
  Faults faults;
  bool help = false;
};

int number(const std::string& option, const std::string& text, int most) {
  std::size_t used = 0;
  int value = -1;
  try {
    value = std::stoi(text, &used);
  } catch (const std::exception&) {
    // Said below.
  }
  if (used != text.size() || value < 0 || value > most)
    throw std::invalid_argument(option + " must be a whole number from 0 to " +
                                std::to_string(most) + ", not '" + text + "'");
  return value;
}

Arguments parse(int argc, char** argv) {
  const option options[] = {{"socket", required_argument, nullptr, 's'},
                            {"uhid", no_argument, nullptr, 'u'},
                            {"plus", no_argument, nullptr, 'p'},
                            {"address", required_argument, nullptr, 'a'},
                            {"battery", required_argument, nullptr, 'b'},
                            {"lights", required_argument, nullptr, 'l'},
                            {"fault", required_argument, nullptr, 'f'},
                            {"help", no_argument, nullptr, 'h'},
                            {nullptr, 0, nullptr, 0}};
  Arguments arguments;
  for (;;) {
    const int found = ::getopt_long(argc, argv, "h", options, nullptr);
    if (found < 0)
      break;
    switch (found) {
      case 's':
        arguments.socket = optarg;
        break;
      case 'u':
        arguments.uhid = true;
        break;
      case 'p':
        arguments.plus = true;
        break;
      case 'a':
        arguments.address = optarg;
        break;
      case 'b':
        arguments.battery = number("--battery", optarg, 255);
        break;
      case 'l':
        arguments.lights = number("--lights", optarg, 16);
        break;
      case 'f':
        setFault(arguments.faults, optarg);
        break;
      case 'h':
        arguments.help = true;
        break;
      default:
        throw std::invalid_argument("see --help");
    }
  }
  if (optind < argc)
    throw std::invalid_argument(std::string("'") + argv[optind] + "' is no option; see --help");
  if (!arguments.help && arguments.uhid == !arguments.socket.empty())
    throw std::invalid_argument("give either --socket PATH or --uhid");
  return arguments;
}

Device::Options deviceOptions(const Arguments& arguments) {
  Device::Options options;
  options.battery = static_cast<std::uint8_t>(arguments.battery);
  options.motion_plus = arguments.plus;
  // Remotes of different addresses are different remotes.
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

/// Says what a person would see and feel of the remote.
class Display {
 public:
  template <typename Remote>
  void show(const Remote& remote) {
    const int leds = remote.leds();
    const bool rumble = remote.rumble();
    if (leds != leds_)
      std::printf("LEDs: %c %c %c %c\n", leds & 1 ? '1' : '-', leds & 2 ? '2' : '-',
                  leds & 4 ? '3' : '-', leds & 8 ? '4' : '-');
    if (rumble != rumble_)
      std::printf("motor: %s\n", rumble ? "on" : "off");
    leds_ = leds;
    rumble_ = rumble;
  }

 private:
  int leds_ = 0;
  bool rumble_ = false;
};

template <typename Remote>
void run(Remote& remote, const Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  remote.setFaults(arguments.faults);
  Display display;
  const Clock::time_point start = Clock::now();
  for (int i = 0; !stop; ++i) {
    std::this_thread::sleep_until(start + i * std::chrono::milliseconds(10));
    remote.sample(sense(arguments.lights, 0.01 * i));
    display.show(remote);
  }
}

void runFor(const Arguments& arguments) {
  if (!arguments.uhid) {
    Server server(arguments.socket, arguments.address, deviceOptions(arguments));
    std::printf("a virtual Wii Remote, device virtual:%s\n", arguments.socket.c_str());
    run(server, arguments);
    return;
  }
  UhidDevice::Options options;
  options.device = deviceOptions(arguments);
  options.model = arguments.plus ? UhidDevice::Model::kRemotePlus : UhidDevice::Model::kRemote;
  UhidDevice device(arguments.address, options);
  std::printf("a virtual Wii Remote, device %s\n", arguments.address.c_str());
  run(device, arguments);
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote

int main(int argc, char** argv) {
  using namespace wiimote_tracker::virtual_wiimote;
  try {
    const Arguments arguments = parse(argc, argv);
    if (arguments.help) {
      std::fputs(kUsage, stdout);
      return 0;
    }
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    std::signal(SIGINT, handleSignal);
    std::signal(SIGTERM, handleSignal);
    runFor(arguments);
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "virtual_wiimote: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "virtual_wiimote: %s\n", error.what());
    return 1;
  }
}
