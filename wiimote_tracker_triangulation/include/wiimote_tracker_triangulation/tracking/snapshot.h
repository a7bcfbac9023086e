#pragma once

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// As in TrackedPoint.msg.
enum class TrackState { kTentative, kTracked, kPredicted, kLost };

/// Cameras of one LED that are remembered.
constexpr std::size_t kMaximumCameras = 64;

/// Indices of cameras. Never allocates.
using CameraList = boost::container::static_vector<std::size_t, kMaximumCameras>;

/// One LED at the time of its snapshot; fields as in TrackedPoint.msg.
struct TrackedLed {
  std::uint32_t id = 0;  ///< Never used again for another LED.
  TrackState state = TrackState::kTentative;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();             ///< World [m].
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();  ///< World [m^2].
  std::optional<Eigen::Vector3d> velocity;                        ///< World [m/s].
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  ///< [m^2/s^2]; with a velocity.
  CameraList cameras;             ///< In the rig; whose rays were used, ascending.
  CameraList located_by;          ///< Those that saw it when two cameras last did, in the rig.
  std::size_t rays_possible = 0;  ///< Cameras that should see it, or whose rays were used.

  /// sqrt(mean(du^2 + dv^2)) over the rays used [px]; NaN without any.
  double residual = std::numeric_limits<double>::quiet_NaN();
  double first_seen = 0.0;     ///< [s]
  double last_observed = 0.0;  ///< [s]
  /// Probability that the track did not change places with another one since it was first seen,
  /// when two LEDs met [0..1].
  double same_led_probability = 1.0;
  bool remapped = false;  ///< Corrected where the correction of the volume was measured.
};

/// How one spot was used. kStart: it began an LED's track, together with spots of other cameras.
enum class SpotUse { kUnassigned, kMasked, kAssigned, kStart };

struct SeenSpot {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< Distorted [px].
  SpotUse use = SpotUse::kUnassigned;
  std::uint32_t led = 0;  ///< Id of the LED it was assigned to, or whose track it began.
};

/// A camera's newest image.
struct CameraView {
  std::optional<double> time;  ///< Exposure of its newest image [s]; nothing before the first.
  double stamp_stddev = 0.0;   ///< Of that time [s].
  bool full = false;           ///< As many spots as it can report: more LEDs may be visible.
  std::vector<SeenSpot> spots;
};

/// All LEDs at one time.
struct Snapshot {
  double time = 0.0;              ///< [s]
  double latest_arrival = 0.0;    ///< Of the images used, those without spots too [s].
  double skew = 0.0;              ///< Largest distance in time to an image used [s].
  std::vector<TrackedLed> leds;   ///< In the order of their ids.
  std::vector<CameraView> views;  ///< One per camera, in the order of the rig.
};

}  // namespace wiimote_tracker::tracking
