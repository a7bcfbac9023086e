// Errors of a moving LED with the exposure clock on recorded arrivals of real remotes.
#include "grid_stamps.h"
#include "paper/experiment.h"
#include "remote_camera.h"
#include "room.h"

#include "wiimote_tracker_triangulation/estimators/make_estimator.h"

#include <wiimote_tracker_msgs/benchmark_tables.h>
#include <wiimote_tracker_msgs/median.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

namespace fs = std::filesystem;

constexpr double kLearning = 10.0;     // of the clocks, before the score [s]
constexpr double kFar = 0.5;           // points farther off are not of the LED [m]
constexpr double kInside = 7.814728;   // 95 % of chi squared, three degrees of freedom
constexpr double kExactStddev = 1e-6;  // [s]

/// Source of the stamps.
enum Stamps { kExact, kClock, kGrid, kArrivals };
constexpr std::array<const char*, 4> kNames{"exact", "clock", "grid", "arrivals"};

constexpr char kExplanation[] =
    "Errors of the stamps [ms] against Bayes' rule with the whole recording, told how such remotes "
    "behave (its own deviation: 0.5 ms). grid: that with the arrivals so far; in_2sd: within two "
    "stated deviations. Then RMS errors of a tracked LED [mm]; clock_in_95%: points within their "
    "ellipsoids.";

struct Frame {
  std::size_t camera;
  double exposure;               // [s]
  double arrival;                // [s]
  std::array<double, 4> stamp;   // by Stamps [s]
  std::array<double, 4> stddev;  // [s]
};

/// @returns [s]. @throws Error.
std::vector<double> readArrivals(const fs::path& path) {
  std::ifstream file(path);
  std::vector<double> arrivals;
  for (double milliseconds; file >> milliseconds;)
    arrivals.push_back(1e-3 * milliseconds);
  if (!file.eof() || arrivals.size() < 2 || !std::is_sorted(arrivals.begin(), arrivals.end()))
    throw Error(path.string() + " must hold times in ms that increase, two or more");
  return arrivals;
}

bool isScored(double time, const std::vector<Frame>& frames) {
  return time > frames.front().arrival + kLearning;
}

/// Takes away the constant part of the stamps' errors, which a calibration finds. @returns the
/// rest. Arrivals get its RMS as their standard deviation.
BenchmarkRow settle(Stamps stamps, const std::string& name, std::vector<Frame>* frames) {
  std::vector<double> errors;
  for (const Frame& frame : *frames) {
    if (isScored(frame.arrival, *frames))
      errors.push_back(frame.stamp[stamps] - frame.exposure);
  }
  if (errors.empty())
    throw Error(name + " must be longer than 10 s");
  const double offset = medianOf(&errors);
  double sum = 0.0, squares = 0.0, claimed = 0.0, inside = 0.0;
  for (Frame& frame : *frames) {
    frame.stamp[stamps] -= offset;
    if (!isScored(frame.arrival, *frames))
      continue;
    const double error = std::abs(frame.stamp[stamps] - frame.exposure);
    sum += error;
    squares += error * error;
    claimed += frame.stddev[stamps];
    inside += error < 2.0 * frame.stddev[stamps];
  }
  const auto count = static_cast<double>(errors.size());
  const double rms = std::sqrt(squares / count);
  for (Frame& frame : *frames) {
    if (stamps == kArrivals)
      frame.stddev[stamps] = rms;
  }
  const bool states = stamps != kArrivals;
  const double none = std::numeric_limits<double>::quiet_NaN();
  return {name + " " + kNames[stamps],
          {{"mean_ms", 1e3 * sum / count},
           {"RMS_ms", 1e3 * rms},
           {"stated_ms", states ? 1e3 * claimed / count : none},
           {"in_2sd%", states ? 100.0 * inside / count : none}}};
}

/// @returns the images of a recording such as shuffle01_wm1.txt.
std::vector<Frame> framesOf(std::size_t camera, const fs::path& path, const RowCallback& row) {
  const std::vector<double> arrivals = readArrivals(path);
  const GridStamps grid = gridStamps(arrivals);
  exposure_clock::ExposureClock clock;
  std::vector<Frame> frames;
  frames.reserve(arrivals.size());
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const exposure_clock::Estimate estimate = clock.update(arrivals[i]);
    const double exposure = grid.smoothed[i].exposure;
    frames.push_back({camera,
                      exposure,
                      arrivals[i],
                      {exposure, estimate.exposure, grid.filtered[i].exposure, arrivals[i]},
                      {kExactStddev, estimate.stddev, grid.filtered[i].stddev, 0.0}});
  }
  for (const Stamps stamps : {kClock, kGrid, kArrivals})
    row(settle(stamps, path.stem(), &frames));
  return frames;
}

struct Score {
  double squares = 0.0;  // [m^2]
  double inside = 0.0;   // in the 95 % ellipsoid
  double count = 0.0;

  double rms() const { return std::sqrt(squares / count); }  // [m]
};

/// The LED on a circle, seen at the exposures and tracked by the stamps.
Score follow(const simulation::Description& description,
             const std::vector<Frame>& frames,
             double speed,
             Stamps stamps) {
  const auto path = [&](double time) {
    return onCircle(kUpperCircle, speed / kCircleRadius * time);
  };
  std::vector<simulation::VirtualCamera> optics;
  std::vector<RemoteCamera> sensors;
  for (const simulation::CameraDescription& camera : description.cameras) {
    optics.emplace_back(camera.camera, description.pixel_noise,
                        static_cast<std::uint32_t>(optics.size() + 1));
    sensors.emplace_back("wii_3");
  }
  const auto estimator = estimators::makeEstimator(trueRig(description), {});
  Score score;
  tracking::CameraImage image;
  for (const Frame& frame : frames) {
    image.spots =
        sensors[frame.camera].look(optics[frame.camera].sense({{path(frame.exposure), 3.0, 1.0}}));
    image.arrival = frame.arrival;
    image.stamp = frame.stamp[stamps];
    image.stamp_stddev = frame.stddev[stamps];
    estimator->add(frame.camera, image);
    while (const tracking::Snapshot* snapshot = estimator->next()) {
      if (!isScored(snapshot->time, frames))
        continue;
      const Eigen::Vector3d truth = path(snapshot->time);
      for (const tracking::TrackedLed& led : snapshot->leds) {
        const Eigen::Vector3d error = led.position - truth;
        if (led.state != tracking::TrackState::kTracked || error.norm() > kFar)
          continue;
        score.squares += error.squaredNorm();
        score.inside += error.dot(led.position_covariance.ldlt().solve(error)) < kInside;
        ++score.count;
      }
    }
  }
  return score;
}

void run(const std::string& rig, const std::vector<fs::path>& files, BenchmarkTables* tables) {
  simulation::Description description = simulation::readDescription(rig);
  if (files.size() < 2 || files.size() > description.cameras.size())
    throw BadArguments("a file for each of the first cameras of the rig is needed, two or more");
  description = withCameras(description, files.size());
  std::string command = "rosrun wiimote_tracker_bringup evaluate_arrivals " + rig;
  for (const fs::path& file : files)
    command += " " + file.filename().string();
  tables->begin("arrivals " + files[0].stem().string(), kExplanation, command);
  const RowCallback row = [&](const BenchmarkRow& next) { tables->add(next); };
  std::vector<Frame> frames;
  double end = std::numeric_limits<double>::infinity();
  for (std::size_t camera = 0; camera < files.size(); ++camera) {
    const std::vector<Frame> own = framesOf(camera, files[camera], row);
    frames.insert(frames.end(), own.begin(), own.end());
    end = std::min(end, own.back().arrival);
  }
  frames.erase(std::remove_if(frames.begin(), frames.end(),
                              [&](const Frame& frame) { return frame.arrival > end; }),
               frames.end());
  std::stable_sort(frames.begin(), frames.end(),
                   [](const Frame& a, const Frame& b) { return a.arrival < b.arrival; });
  for (const double speed : {0.5, 1.0, 2.0, 3.0}) {
    std::array<Score, 4> scores;
    for (const Stamps stamps : {kExact, kClock, kGrid, kArrivals})
      scores[stamps] = follow(description, frames, speed, stamps);
    const double exact = scores[kExact].rms();
    row({format("%g m/s", speed),
         {{"exact", 1e3 * exact},
          {"clock", 1e3 * scores[kClock].rms()},
          {"grid", 1e3 * scores[kGrid].rms()},
          {"arrivals", 1e3 * scores[kArrivals].rms()},
          {"clock/exact", scores[kClock].rms() / exact},
          {"grid/exact", scores[kGrid].rms() / exact},
          {"clock_in_95%", 100.0 * scores[kClock].inside / scores[kClock].count}}});
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  std::string rig;
  ArgumentParser::Words files;
  ArgumentParser parser(
      "evaluate_arrivals",
      "Tracks a simulated LED by images that arrive as reports of real remotes did. RIG: a "
      "description\nof a rig. FILE: arrivals of the reports of a remote [ms], in order, one file "
      "for each camera.\nThe exposures are those by Bayes' rule with the whole recording.");
  BenchmarkTables tables;
  tables.addOptions(&parser);
  parser.positional("RIG", &rig);
  parser.positional("FILE...", &files);
  return parser.run(argc, argv, [&] {
    monte_carlo::run(rig, {files.begin(), files.end()}, &tables);
    tables.write();
    return 0;
  });
}
