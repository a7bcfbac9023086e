// Identification of blinking LEDs and its duration, from the light on the sensor to the label: the
// paper's scheme for several periods, and cyclic codes for several chip durations.
#include "program.h"
#include "room.h"

#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"
#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

using namespace identity;

constexpr double kDuration = 4.0;     // of a session [s]
constexpr double kExposure = 0.001;   // of an image [s]
constexpr double kNear = 0.05;        // a track this close to an LED belongs to it [m]
constexpr double kPeriodDoubt = 1.2;  // the period is known to within this factor

struct Scheme {
  std::string name;
  double length;  // of a period, or of a chip [s]
  BlinkCodes codes;
  double period;  // [s]
};

Scheme paperScheme(double period) {
  return {"paper", period,
          dutyCodes({{"led_1", 0.9}, {"led_2", 0.6}, {"led_3", 0.4}, {"led_4", 0.2}},
                    period / kPeriodDoubt, period * kPeriodDoubt),
          period};
}

Scheme cyclicScheme(double chip) {
  std::vector<CyclicLed> leds;
  for (const std::string& word : chooseWords(4))
    leds.push_back({"led_" + std::to_string(leds.size() + 1), word});
  return {"cyclic", chip, cyclicCodes(leds, chip, 0.001),
          chip * static_cast<double>(leds[0].word.size())};
}

/// In the middle of the cube, one above the other: no two spots merge in any camera.
const std::vector<Eigen::Vector3d> kPlaces = {{1.05, 1.05, 0.8},
                                              {1.45, 1.05, 1.1},
                                              {1.45, 1.45, 1.4},
                                              {1.05, 1.45, 1.7}};

struct Outcome {
  int labelled = 0;         // LEDs with a label at the end
  int wrong = 0;            // LEDs with the label of another one
  bool ever_wrong = false;  // an LED had a wrong label at any time
  double seconds = std::numeric_limits<double>::quiet_NaN();  // until all labels were right
};

Outcome identify(const simulation::Description& description,
                 const Scheme& scheme,
                 std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto share = [&] { return random() / 4294967296.0; };
  const double common = share();
  std::vector<double> phases;
  for (std::size_t led = 0; led < kPlaces.size(); ++led)
    phases.push_back(scheme.codes.synchronous ? common : share());
  std::vector<Path> paths;
  for (const Eigen::Vector3d& place : kPlaces)
    paths.push_back([place](double) { return place; });
  const Hidden hidden = [&](std::size_t, std::size_t led, double time) {
    const double begin = (time - 0.5 * kExposure) / scheme.period + phases[led];
    return litShare(scheme.codes.codes[led].waveform, begin, kExposure / scheme.period) < 0.5;
  };
  Room room(description, paths, seed, hidden);
  const geometry::Rig rig = trueRig(description);
  tracking::Tracker tracker(rig, forBlinking(scheme.codes, {}));
  Identifier identifier(scheme.codes, {});
  SnapshotSightings sightings{SnapshotSightingsOptions()};
  Outcome outcome;
  for (const RoomImage& image : record(&room, kDuration)) {
    tracker.add(image.camera, image.image);
    while (const tracking::Snapshot* snapshot = tracker.next()) {
      sightings.add(rig, *snapshot, &identifier);
      outcome.labelled = outcome.wrong = 0;
      for (std::size_t led = 0; led < kPlaces.size(); ++led) {
        for (const tracking::TrackedLed& track : snapshot->leds) {
          const Identity* identity = identifier.identityOf(track.id);
          if ((track.position - kPlaces[led]).norm() > kNear || !identity || !identity->label)
            continue;
          ++outcome.labelled;
          outcome.wrong += *identity->label != led;
        }
      }
      outcome.ever_wrong |= outcome.wrong > 0;
      const bool all = outcome.labelled == static_cast<int>(kPlaces.size()) && outcome.wrong == 0;
      if (all && std::isnan(outcome.seconds))
        outcome.seconds = snapshot->latest_arrival;
    }
  }
  return outcome;
}

void measure(const simulation::Description& all, const Session& session, Table* table) {
  std::vector<Scheme> schemes;
  for (const double ms : {25, 30, 40, 50, 60, 70, 80, 100, 120, 150, 200, 300, 500})
    schemes.push_back(paperScheme(1e-3 * ms));
  for (const double ms : {3, 4, 6, 8, 10, 12, 15, 20, 23, 30, 40})
    schemes.push_back(cyclicScheme(1e-3 * ms));
  for (const std::size_t cameras : {std::size_t{2}, all.cameras.size()}) {
    const simulation::Description description = withCameras(all, cameras);
    for (const Scheme& scheme : schemes) {
      const Outcome outcome = identify(description, scheme, session.seed);
      *table << session.number << description.cameras.size() << scheme.name << 1e3 * scheme.length
             << 1e3 * scheme.period << outcome.labelled << outcome.wrong << outcome.ever_wrong
             << outcome.seconds;
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "Labels of four blinking LEDs and the time until all are right: the paper's scheme "
      "(90/60/40/20 %) over the period, cyclic codes over the chip.",
      {"session", "cameras", "scheme", "length_ms", "period_ms", "labelled", "wrong", "ever_wrong",
       "time_s"},
      wiimote_tracker::monte_carlo::measure);
}
