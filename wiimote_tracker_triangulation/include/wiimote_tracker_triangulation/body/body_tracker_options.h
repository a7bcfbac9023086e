#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_OPTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_OPTIONS_H

#include "wiimote_tracker_triangulation/body/inertial_filter.h"
#include "wiimote_tracker_triangulation/body/pose_filter.h"

namespace wiimote_tracker::body {

struct BodyTrackerOptions {
  double pixel_stddev = 0.5;     ///< Noise per coordinate of a spot [px, > 0].
  bool learnt_noise = true;      ///< Updates use the calibration's (geometry::pixelNoise).
  double stamp_stddev = 0.0005;  ///< Of images without one of their own [s, >= 0].
  PoseFilterOptions motion;
  InertialOptions inertial;  ///< Of bodies with an IMU.

  /// Gate: greatest squared Mahalanobis distance of a spot from an LED's prediction [1, > 0].
  double gate = 16.0;

  /// LEDs closer than this in an image may merge into one spot [px, >= 0].
  double merging_distance = 24.0;

  double prediction_time = 0.5;  ///< A body unseen for longer is lost [s, > 0].
  double tracked_time = 0.03;    ///< Tracked if seen this recently, else predicted [s, > 0].

  // Search for bodies that are not tracked.
  double window = 0.015;         ///< Images this close in time are combined [s, > 0].
  double window_motion = 0.002;  ///< LED motion within the window (std. dev.) [m, > 0].
  double minimum_margin = 15.0;  ///< Least Match::margin to start a body [> 0].

  double history = 0.2;         ///< Images that are later than this are dropped [s, >= 0].
  double maximum_range = 20.0;  ///< Greatest range of a camera [m, > 0].
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_OPTIONS_H
