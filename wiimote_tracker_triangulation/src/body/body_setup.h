#pragma once

#include "body/constellation.h"
#include "body/inertial_filter.h"
#include "body/inertial_samples.h"
#include "wiimote_tracker_triangulation/body/pose_filter.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::body {

struct BodyTrackerOptions : tracking::ImageOptions {
  PoseFilterOptions motion;
  InertialOptions inertial;  ///< Of bodies with an IMU.

  /// Gate: greatest squared Mahalanobis distance of a spot from an LED's prediction [1, > 0].
  double gate = 16.0;

  double prediction_time = 0.5;  ///< A body unseen for longer is lost [s, > 0].
  double tracked_time = 0.03;    ///< Tracked if seen this recently, else predicted [s, > 0].

  // Search for bodies that are not tracked.
  double window = 0.015;         ///< Images this close in time are combined [s, > 0].
  double window_motion = 0.002;  ///< LED motion within the window (std. dev.) [m, > 0].
  double minimum_margin = 15.0;  ///< Least Match::margin to start a body [> 0].
};

/// A body to track.
struct BodyModel {
  explicit BodyModel(const Constellation& leds)
      : constellation(leds),
        has_clear_shape(nearestSymmetry(leds).residual >= kSymmetric),
        inertial(leds.imu.value_or(ImuMount()).body_from_imu.translation()) {}

  Constellation constellation;
  bool has_clear_shape;      ///< Not symmetric.
  InertialSamples inertial;  ///< Empty without IMU.
};

/// What BodyTracker tracks, and with what. No image changes it.
struct BodySetup {
  BodyTrackerOptions options;
  geometry::Rig rig;
  std::vector<geometry::Camera> cameras;           ///< As Rig::rayCamera.
  std::vector<std::vector<std::size_t>> partners;  ///< See geometry::sharedViews.
  std::vector<BodyModel> bodies;
};

}  // namespace wiimote_tracker::body
