#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_INERTIAL_SAMPLES_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_INERTIAL_SAMPLES_H

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::body {

/// What an IMU on a body measured, along the body's axes.
struct InertialSample {
  double time;            ///< By the clock of the images [s].
  Eigen::Vector3d rate;   ///< Angular velocity [rad/s].
  Eigen::Vector3d force;  ///< Specific force: acceleration less that of gravity [m/s^2].
};

/// The samples of an IMU in the last seconds. Does not allocate once warm.
class InertialSamples {
 public:
  /// @param place of the IMU in the body's frame [m].
  explicit InertialSamples(const Eigen::Vector3d& place) : place_(place) {}

  const Eigen::Vector3d& place() const { return place_; }

  /// A sample that is not newer than all others is ignored, unless time jumped back, as when a bag
  /// starts again: then the others are forgotten.
  /// @returns the time after which this changes what at() says [s].
  double add(const InertialSample& sample);

  void clear() { samples_.clear(); }

  /// Whether no two successive samples are too far apart (0.05 s) from `begin` to `end` [s].
  bool cover(double begin, double end) const;

  /// Interpolated; after the newest sample, the newest. Only if they cover the time.
  InertialSample at(double time) const;

  /// Time of the first sample after a time; infinity without [s].
  double nextAfter(double time) const;

  double frequency() const;  ///< Of the samples; 0 for fewer than two [Hz].

 private:
  std::vector<InertialSample>::const_iterator after(double time) const;

  Eigen::Vector3d place_;
  std::vector<InertialSample> samples_;  // sorted by time
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_INERTIAL_SAMPLES_H
