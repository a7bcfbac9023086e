// Tracking of an LED that is occluded from each camera at random times.
#include "paper/experiment.h"
#include "program.h"
#include "room.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kDuration = 12.0;    // of a session [s]
constexpr double kSettled = 2.0;      // start of the score [s]
constexpr double kMeanHidden = 0.25;  // mean duration of an occlusion [s]
constexpr double kNear = 0.05;        // points farther off are not of the LED [m]
constexpr double kStep = 0.005;       // time step of the score [s]
constexpr double kInside = 7.815;     // 95 % quantile of chi^2, three degrees of freedom

/// Occlusions of the LED from one camera: visible and hidden times alternate, both exponential.
class Occlusions {
 public:
  Occlusions(double hidden_share, std::mt19937* random) {
    const auto exponential = [&](double mean) {
      return -mean * std::log(((*random)() + 0.5) / 4294967296.0);
    };
    const double mean_free =
        hidden_share > 0.0 ? kMeanHidden * (1.0 - hidden_share) / hidden_share : 1e9;
    for (double time = exponential(mean_free); time < kDuration;
         time = turns_.back() + exponential(mean_free)) {
      turns_.push_back(time);
      turns_.push_back(time + exponential(kMeanHidden));
    }
  }

  bool isHidden(double time) const {
    return (std::upper_bound(turns_.begin(), turns_.end(), time) - turns_.begin()) % 2 == 1;
  }

 private:
  std::vector<double> turns_;  // start, end, start, ... of occlusions [s]
};

struct Method {
  const char* name;
  estimators::TrackerMode mode;
  bool takes_predicted;  // points seen by fewer than two cameras
};

constexpr Method kMethods[] = {{"tracks", estimators::TrackerMode::kTracks, true},
                               {"tracked", estimators::TrackerMode::kTracks, false},
                               {"instants", estimators::TrackerMode::kInstant, true}};

struct Score {
  double squared = 0.0;  // of the errors [m^2]
  int published = 0;     // points
  int astray = 0;        // points farther off than kNear
  int inside = 0;        // points whose 95 % ellipsoid contains the LED
  double covered = 0.0;  // time with a fresh point of the LED [s]
};

Score follow(const geometry::Rig& rig,
             const std::vector<RoomImage>& images,
             const Path& path,
             const Method& method) {
  constexpr double kFresh = 0.025;  // greatest age of a fresh point [s]
  estimators::EstimatorOptions options;
  options.tracker_mode = method.mode;
  Score score;
  double last = kSettled;
  trackImages(rig, options, images, [&](double time, const tracking::Snapshot& snapshot) {
    if (time < kSettled || time > kDuration)
      return;
    for (const tracking::TrackedLed& led : snapshot.leds) {
      if (led.state != tracking::TrackState::kTracked &&
          !(method.takes_predicted && led.state == tracking::TrackState::kPredicted))
        continue;
      const Eigen::Vector3d offset = led.position - path(time);
      score.inside += offset.dot(led.position_covariance.inverse() * offset) < kInside;
      const double error = offset.norm();
      if (error > kNear) {
        ++score.astray;
        continue;
      }
      score.squared += error * error;
      ++score.published;
      score.covered += std::min(time - last, kFresh);
      last = time;
    }
  });
  return score;
}

/// Share of the time in which at least two cameras see the LED, as triangulation requires.
double shareOfTwoViews(const std::vector<Occlusions>& occlusions) {
  int seen = 0, all = 0;
  for (double time = kSettled; time < kDuration; time += kStep) {
    const auto open =
        std::count_if(occlusions.begin(), occlusions.end(),
                      [&](const Occlusions& camera) { return !camera.isHidden(time); });
    seen += open >= 2;
    ++all;
  }
  return static_cast<double>(seen) / all;
}

void measure(const simulation::Description& all, const Session& session, Table* table) {
  for (const std::size_t cameras : {std::size_t{2}, all.cameras.size()}) {
    const simulation::Description description = withCameras(all, cameras);
    const geometry::Rig rig = trueRig(description);
    for (const double hidden_share : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}) {
      std::mt19937 random(session.seed);
      std::vector<Occlusions> occlusions;
      for (std::size_t i = 0; i < description.cameras.size(); ++i)
        occlusions.emplace_back(hidden_share, &random);
      const double phase = 2.0 * M_PI * (random() / 4294967296.0);
      const Path path = [=](double time) {  // at 1 m/s
        return onCircle(kUpperCircle, phase + time / kCircleRadius);
      };
      const Hidden hidden = [&](std::size_t camera, std::size_t, double time) {
        return occlusions[camera].isHidden(time);
      };
      Room room(description, {path}, session.seed, hidden);
      const std::vector<RoomImage> images = record(&room, kDuration);
      for (const Method& method : kMethods) {
        const Score score = follow(rig, images, path, method);
        const double points = score.astray + score.published;
        *table << session.number << description.cameras.size() << hidden_share << method.name
               << score.covered / (kDuration - kSettled) << shareOfTwoViews(occlusions)
               << score.astray / points << score.inside / points
               << 1e3 * std::sqrt(score.squared / score.published);
      }
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "An LED on a circle, hidden from each camera at random for 0.25 s on average: share of the "
      "time with a position, and its accuracy.",
      {"session", "cameras", "hidden_share", "method", "covered_share", "two_views_share",
       "astray_share", "inside_share", "rms_mm"},
      wiimote_tracker::monte_carlo::measure);
}
