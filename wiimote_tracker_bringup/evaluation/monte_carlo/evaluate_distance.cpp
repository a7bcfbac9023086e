// How far off a light is seen: the paper's measurement with the virtual Wii Remote's own sensor.
#include "arguments.h"
#include "description.h"
#include "remote_camera.h"
#include "table.h"
#include "virtual_camera.h"

#include <cmath>
#include <random>
#include <string>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kImageInterval = 0.01;  // [s]
constexpr double kTimeLimit = 0.5;       // the paper's: no other position for so long [s]
constexpr double kStart = 0.5;           // from the light, where the carrying begins [m]
constexpr double kEnd = 200.0;           // where it is given up [m]
constexpr double kSpeed = 0.25;          // of a person who walks slowly backwards [m/s]
// The small circles: the remote's direction goes round. The light's spot then moves by pixels at
// any distance, which a shift of the remote would not make it do.
constexpr double kCircleAngle = 0.02;  // radius [rad]: 26 px
constexpr double kCircleRate = 1.0;    // [Hz]

struct Carried {
  double stopped_at;  // when its position had not changed for the time limit [m]
  double last_seen;   // at the last image that shows it [m]
};

/// Carries a remote away from a light of a brightness (1: the Wii's sensor bar).
Carried carry(const simulation::Description& description,
              const std::string& sensitivity,
              double brightness,
              std::mt19937* random) {
  geometry::Camera camera = description.cameras.front().camera;
  RemoteCamera sensor(sensitivity);
  const double phase = 2.0 * M_PI * ((*random)() / 4294967296.0);
  const auto noise_seed = static_cast<std::uint32_t>((*random)());
  camera.world_from_camera.setIdentity();
  simulation::VirtualCamera optics(camera, description.pixel_noise, noise_seed);
  Eigen::Vector2d before(-1.0, -1.0);
  double changed = 0.0;
  Carried carried{kEnd, 0.0};
  for (int image = 0;; ++image) {
    const double time = image * kImageInterval;
    const double distance = kStart + kSpeed * time;
    if (distance > kEnd)
      return carried;
    const double angle = phase + 2.0 * M_PI * kCircleRate * time;
    const Eigen::Vector3d place(distance * kCircleAngle * std::cos(angle),
                                distance * kCircleAngle * std::sin(angle), distance);
    const auto& spots = sensor.look(optics.sense({{place, std::nullopt, brightness}}));
    if (!spots.empty())
      carried.last_seen = distance;
    if (!spots.empty() && spots[0].pixel != before) {
      before = spots[0].pixel;
      changed = time;
    }
    if (time - changed >= kTimeLimit) {
      carried.stopped_at = distance;
      return carried;
    }
  }
}

void measure(const Arguments& arguments) {
  const simulation::Description description = simulation::readDescription(arguments.rig);
  Table table(arguments.output,
              {"session", "sensitivity", "brightness", "stopped_at_m", "last_seen_m"});
  for (int session = arguments.first; session < arguments.first + arguments.sessions; ++session) {
    std::mt19937 random(sessionSeed(arguments, session));
    for (const char* sensitivity : {"wii_1", "wii_2", "wii_3", "wii_4", "wii_5", "max"}) {
      for (const double brightness : {0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0}) {
        const Carried carried = carry(description, sensitivity, brightness, &random);
        table << session << sensitivity << brightness << carried.stopped_at << carried.last_seen;
      }
    }
  }
  table.close();
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "Carries a virtual Wii Remote away from lights of several brightnesses (1: the Wii's sensor "
      "bar) until the position it reports has not changed for 0.5 s.",
      wiimote_tracker::monte_carlo::measure);
}
