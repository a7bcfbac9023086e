#pragma once

#include "body/inertial_filter.h"
#include "wiimote_tracker_triangulation/body/pose_filter.h"

#include <algorithm>
#include <limits>
#include <variant>

namespace wiimote_tracker::body {

/// The filter of a body: an InertialFilter from when the body is seen while its IMU delivers, until
/// the IMU pauses or is not plausible; else a PoseFilter. A value type; never allocates.
class BodyFilter {
 public:
  /// @param motion, inertial not owned.
  BodyFilter(const PoseFilterOptions& motion,
             const InertialOptions& inertial,
             const PoseFilter& start)
      : motion_(&motion), inertial_(&inertial), filter_(start) {}

  /// @param samples of the body's IMU; none without one.
  void predict(double time, const InertialSamples& samples) {
    const auto* before = std::get_if<InertialFilter>(&filter_);
    if (before && !samples.cover(before->time(), time))
      filter_ = PoseFilter(*motion_, before->time(), before->state());
    if (auto* inertial = std::get_if<InertialFilter>(&filter_))
      inertial->predict(time, samples);
    else
      std::get<PoseFilter>(filter_).predict(time);
  }

  /// As PoseFilter::update.
  void update(const LedPrediction& prediction,
              const Eigen::Vector2d& pixel,
              const InertialSamples& samples) {
    std::visit([&](auto& filter) { filter.update(prediction, pixel); }, filter_);
    if (const auto* inertial = std::get_if<InertialFilter>(&filter_)) {
      if (inertial->isPlausible())
        return;
      distrust(inertial->time());
      filter_ = PoseFilter(*motion_, inertial->time(), inertial->state());
    } else if (const auto& pose = std::get<PoseFilter>(filter_);
               pose.time() >= distrusted_until_ && samples.cover(pose.time(), pose.time())) {
      filter_ = InertialFilter(*inertial_, pose.time(), pose.state(), samples);
    }
  }

  /// The body was found anew at `time` [s], where the filter before was wrong: does without the IMU
  /// for a while if that had used it.
  void distrustAfter(const BodyFilter& before, double time) {
    distrusted_until_ = before.distrusted_until_;
    pause_ = before.pause_;
    if (before.isInertial())
      distrust(time);
  }

  const PoseState& state() const {
    return std::visit([](const auto& filter) -> const PoseState& { return filter.state(); },
                      filter_);
  }

  bool isInertial() const { return std::holds_alternative<InertialFilter>(filter_); }

 private:
  // How long an IMU that was not plausible is left out: the first time, at most [s].
  static constexpr double kPause = 10.0;
  static constexpr double kLongestPause = 320.0;

  /// Leaves the IMU out from a time [s]; twice as long as the last time if that pause ended less
  /// than its own length ago. Each time that a wrong one is tried, the pose is off by up to 3 cm.
  void distrust(double time) {
    const bool again = time < distrusted_until_ + pause_;
    pause_ = again ? std::min(2.0 * pause_, kLongestPause) : kPause;
    distrusted_until_ = time + pause_;
  }

  const PoseFilterOptions* motion_;
  const InertialOptions* inertial_;
  std::variant<PoseFilter, InertialFilter> filter_;
  double distrusted_until_ = -std::numeric_limits<double>::infinity();  // the IMU [s]
  double pause_ = 0.0;  // length of the pause that ends then [s]
};

}  // namespace wiimote_tracker::body
