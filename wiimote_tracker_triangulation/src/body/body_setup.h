#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_BODY_SETUP_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_BODY_SETUP_H

#include "wiimote_tracker_triangulation/body/body_tracker.h"
#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/body/inertial_samples.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::body {

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

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_BODY_SETUP_H
