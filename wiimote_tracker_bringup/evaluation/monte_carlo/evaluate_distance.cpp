// Greatest distance at which a light is seen: the paper's measurement with a virtual Wii Remote.
#include "description.h"
#include "program.h"
#include "remote_camera.h"
#include "virtual_camera.h"

#include <cmath>
#include <random>
#include <string>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kImageInterval = 0.01;  // [s]
constexpr double kTimeLimit = 0.5;       // the paper's: time without a new position [s]
constexpr double kStart = 0.5;           // initial distance from the light [m]
constexpr double kEnd = 200.0;           // greatest distance tried [m]
constexpr double kSpeed = 0.25;          // of a person walking slowly backwards [m/s]
// The paper's small circles: the direction of the remote rotates. Unlike a translation this moves
// the spot by pixels at any distance.
constexpr double kCircleAngle = 0.02;  // radius [rad]: 26 px
constexpr double kCircleRate = 1.0;    // [Hz]

struct Carried {
  double stopped_at;  // where the position stayed for the time limit [m]
  double last_seen;   // at the last image with a spot [m]
};

/// Moves a remote away from a light of a brightness (1: the Wii's sensor bar).
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

void measure(const simulation::Description& description, const Session& session, Table* table) {
  std::mt19937 random(session.seed);
  for (const char* sensitivity : {"wii_1", "wii_2", "wii_3", "wii_4", "wii_5", "max"}) {
    for (const double brightness : {0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0}) {
      const Carried carried = carry(description, sensitivity, brightness, &random);
      *table << session.number << sensitivity << brightness << carried.stopped_at
             << carried.last_seen;
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "Moves a virtual Wii Remote away from lights of several brightnesses (1: the Wii's sensor "
      "bar) until the reported position has not changed for 0.5 s.",
      {"session", "sensitivity", "brightness", "stopped_at_m", "last_seen_m"},
      wiimote_tracker::monte_carlo::measure);
}
