#ifndef WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_MEASUREMENT_H
#define WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_MEASUREMENT_H

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <string>

namespace wiimote_tracker::measurements {

/// One row of a table: an LED at a time; fields as in TrackedPoint.msg.
struct Measurement {
  std::int64_t stamp = 0;  ///< [ns since 1970]
  bool triggered = false;  ///< Interpolated for a trigger, see events::Trigger.
  std::uint32_t id = 0;
  std::string label;
  double label_confidence = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not estimated.
  std::int64_t label_since = 0;                        ///< [ns since 1970]; 0: not estimated.
  std::string state;                                   ///< "tracked", ...
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();  ///< [m^2]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();             ///< [m/s]; NaN: unknown.
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  ///< [m^2/s^2]; NaN: unknown.
  std::uint32_t rays_used = 0;
  std::uint32_t rays_possible = 0;
  double residual = 0.0;           ///< [px]; NaN: no ray was used.
  std::int64_t last_observed = 0;  ///< [ns since 1970]
  double age = 0.0;                ///< [s]
  bool remapped = false;
  std::string frame;  ///< World frame.
  std::string rig_id;
  std::string method;
};

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_MEASUREMENT_H
