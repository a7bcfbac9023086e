// A rig that corrects itself: eight hours of drift, knocks and reconnects, compressed to the
// motion.
#include "benchmark_calibration_sections.h"
#include "wave_trial.h"
#include "waved_led.h"

#include "continuous/continuous_calibration.h"
#include "continuous/rig_changes.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

namespace {

using continuous::ContinuousCalibration;

constexpr double kOneDegree = M_PI / 180.0;
constexpr int kHours = 8;
constexpr int kStepsPerHour = 6;                // Of the drift.
constexpr double kMotion = 60.0;                // After each step [s].
constexpr double kPause = 540.0;                // Without images before each step [s].
constexpr double kDriftPerHour = 0.5 / 1300.0;  // 0.5 px [rad].
constexpr double kChiSquared = 12.592;          // 95 %, six degrees of freedom.

/// How far points of the volume that rest seem to move when a rig is replaced, RMS [m].
double movementOf(const std::vector<geometry::RigCamera>& truth,
                  const geometry::Rig& from,
                  const geometry::Rig& to) {
  const std::vector<geometry::Camera> cameras = wave::camerasOf(truth);
  const std::vector<Eigen::Vector3d> points = wave::cubePoints(cameras);
  const auto errors = [&](const geometry::Rig& rig) {
    return wave::pointErrors(cameras, wave::camerasOf(rig.cameras), points);
  };
  return std::sqrt((errors(to) - errors(from)).colwise().squaredNorm().mean());
}

/// How a turn, a shift and a growth of the world move a point.
Eigen::Matrix<double, 3, 7> withWorld(const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 3, 7> motion;
  motion << -geometry::so3::skew(point), Eigen::Matrix3d::Identity(), point;
  return motion;
}

/// RMS error of the volume that no images take away [m]: they show how cameras and lenses are to
/// each other, at best exactly, but not the world, of which the rig's covariance tells all that is
/// known (generalised least squares). Drift and knocks take only away from that.
double boundOf(const geometry::Rig& rig) {
  Eigen::MatrixXd by_world = Eigen::MatrixXd::Zero(rig.covariance.rows(), 7);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Eigen::Index first = geometry::firstParameter(i);
    by_world.block<3, 3>(first + geometry::kRotation, 0).setIdentity();
    by_world.middleRows<3>(first + geometry::kPosition) = withWorld(rig.cameras[i].camera.center());
  }
  Eigen::MatrixXd covariance = rig.covariance;
  covariance.diagonal().array() += 1e-12;  // parameters that were held have no variance
  const Eigen::MatrixXd world =
      geometry::inverseOfInformation(by_world.transpose() *
                                     geometry::solveSymmetric(covariance, by_world))
          .value();
  double squared = 0.0;
  const auto points = wave::cubePoints(wave::camerasOf(rig.cameras));
  for (const Eigen::Vector3d& point : points)
    squared += geometry::propagated(withWorld(point), world).trace();
  return std::sqrt(squared / static_cast<double>(points.size()));
}

/// What is known after an hour, over all runs.
struct Hour {
  double kept = 0.0;       // Mean squared error of the volume with the first rig [m^2].
  double corrected = 0.0;  // With the rig that corrects itself [m^2].
  wave::Share covered;     // Poses in their 95 % region.
  double nees = 0.0;       // Of all poses.
  int changes = 0;
  double step = 0.0;  // Farthest that points at rest moved when the rig in use was replaced [m].
};

/// One day: `hours` has the state before it, then after each hour.
void addDay(std::uint64_t seed, std::array<Hour, kHours + 1>* hours) {
  square::Random random(seed);
  geometry::Rig first = paperRigWith(wellCalibrated());
  first.solved_at = WavedLed::kClock;
  geometry::Rig rig = first;
  WavedLed led(drawTruth(rig, random), seed + 1000);
  std::array<std::uint32_t, 4> epochs = {7, 7, 7, 7};
  std::optional<ContinuousCalibration> watch;
  watch.emplace(rig, continuous::Options{});
  continuous::RigChanges changes;
  changes.follow(rig);
  // Each camera drifts in one direction all day.
  std::vector<Eigen::Vector3d> axes;
  for (std::size_t i = 0; i < led.truth.size(); ++i)
    axes.push_back(square::anyDirection(random));
  double time = 0.0;
  double pauses = 0.0;
  for (int hour = 0; hour <= kHours; ++hour) {
    Hour& at = (*hours)[static_cast<std::size_t>(hour)];
    for (int step = 0; hour > 0 && step < kStepsPerHour; ++step) {
      for (std::size_t i = 0; i < led.truth.size(); ++i)
        led.truth[i].camera.world_from_camera.rotate(
            Eigen::AngleAxisd(kDriftPerHour / kStepsPerHour, axes[i]));
      const auto any = static_cast<std::size_t>(square::uniform(random, 0.0, 3.999));
      if (step == 0 && (hour == 2 || hour == 4 || hour == 6))
        led.truth[any] =
            turned(led.truth[any], square::uniform(random, 1.0, 3.0) * kOneDegree, random);
      if (step == 0 && (hour == 3 || hour == 5)) {
        led.truth[any].time_offset = square::uniform(random, -0.02, 0.02);
        ++epochs[any];
      }
      time += kMotion;
      pauses += kPause;
      led.runUntil(time, [&](capture::Image image) {
        image.stamp += pauses;
        image.clock_epoch = epochs[static_cast<std::size_t>(image.camera.back() - '1')];
        if (const auto proposal = watch->add(image)) {
          ++at.changes;
          rig = changes.apply(*proposal, rig).value_or(rig);
          watch.emplace(changes.goal(rig), continuous::Options{});
        }
        const auto next = changes.step(rig, image.stamp);
        if (!next)
          return;
        at.step = std::max(at.step, movementOf(led.truth, rig, *next));
        rig = *next;
      });
    }
    at.kept += std::pow(wave::volumeError(led.truth, first), 2);
    at.corrected += std::pow(wave::volumeError(led.truth, rig), 2);
    for (std::size_t i = 0; i < led.truth.size(); ++i) {
      const double nees = square::poseNees(rig, i, led.truth[i].camera);
      at.covered.count(nees < kChiSquared);
      at.nees += nees;
    }
  }
}

void runDays(int runs, const RowCallback& row) {
  std::array<Hour, kHours + 1> hours;
  for (int run = 0; run < runs; ++run)
    addDay(static_cast<std::uint64_t>(run) + 1, &hours);
  const double fresh = hours[0].corrected;
  for (std::size_t hour = 0; hour < hours.size(); ++hour) {
    const Hour& at = hours[hour];
    row({"after " + std::to_string(hour) + " hours",
         {{"kept_mm", 1000.0 * std::sqrt(at.kept / runs)},
          {"all_mm", 1000.0 * std::sqrt(at.corrected / runs)},
          {"/ fresh", std::sqrt(at.corrected / fresh)},
          {"95%", 100.0 * at.covered.inside / at.covered.all},
          {"NEES", at.nees / at.covered.all / 6.0},
          {"changes", static_cast<double>(at.changes) / runs},
          {"step_mm", 1000.0 * at.step}}});
  }
  const double bound = boundOf(paperRigWith(wellCalibrated()));
  row({"bound", {{"all_mm", 1000.0 * bound}, {"/ fresh", bound / std::sqrt(fresh / runs)}}});
}

}  // namespace

BenchmarkSection continuousSection() {
  return {"continuous",
          "eight hours, 0.5 px of drift an hour in each camera, three knocks, two reconnects; RMS "
          "error of the volume with the first rig and with the one that corrects itself, the "
          "latter over that of a fresh calibration; poses in their 95 % region, NEES per "
          "parameter; changes per hour; how far points at rest moved by a step, the farthest. "
          "bound: if images showed everything but where and how large the world is",
          runDays};
}

}  // namespace wiimote_tracker
