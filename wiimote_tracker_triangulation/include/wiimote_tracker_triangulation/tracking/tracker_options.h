#pragma once

#include "wiimote_tracker_triangulation/motion/motion_options.h"

#include <Eigen/Core>

#include <cstddef>

namespace wiimote_tracker::tracking {

/// What the tracking of LEDs and that of bodies assume of images.
struct ImageOptions {
  double pixel_stddev = 0.5;       ///< Measurement noise of a coordinate [px, 0.001..100].
  bool learnt_noise = true;        ///< Updates use that of the calibration, if it tells it.
  double stamp_stddev = 0.0005;    ///< Of images without one of their own [s, 0..0.1].
  double merging_distance = 24.0;  ///< Closer LEDs may merge into one spot [px, 0..100].
  double maximum_range = 20.0;     ///< Of an LED from a camera [m, 0.1..1000].
  double history = 0.2;            ///< Later images are dropped [s, 0.01..2].
};

/// Options of the tracker. The ranges are not checked here.
struct TrackerOptions : ImageOptions {
  motion::MotionOptions motion;

  // Measurements.
  double detection_probability = 0.9;  ///< Of an LED in a camera's view [0.01..0.999].
  double ghost_rate = 0.5;             ///< Mean number of false detections per image [0.001..16].
  double gate = 25.0;                  ///< Squared Mahalanobis distance of a spot [1, 4..100].

  // Tracks.
  double birth_window = 0.03;         ///< Time within which images start a track [s, 0.001..0.2].
  double birth_pixel_stddev = 4.0;    ///< Pixel noise by motion in birth_window [px, 0.1..100].
  double minimum_angle = 0.02;        ///< Between two rays of a new LED [rad, 0.001..1].
  std::size_t confirmation_hits = 8;  ///< Detections that confirm a track [1..1000].
  double minimum_support = 0.5;       ///< Share of the cameras that should see it [0..1].
  double tracked_time = 0.05;         ///< Tracked: seen by two cameras within this [s, 0.001..1].
  double prediction_time = 0.5;       ///< A track not seen for longer is lost [s, 0.01..10].
  double doubt_time = 0.25;           ///< Longest time to decide which LED is which after their
                                      ///< spots were merged [s, 0..5].
  double single_view_time = 0.7;      ///< A track seen by one camera only for longer is lost
                                      ///< [s, 0.01..60].
  double dark_time = 0.0;             ///< Longest dark time of a blinking LED [s, 0..5]; 0: no LED
                                      ///< blinks.

  /// New LEDs are accepted inside this box only [m]. Reflections in floors and windows appear
  /// outside the room.
  Eigen::Vector3d minimum_corner = Eigen::Vector3d::Constant(-1e6);
  Eigen::Vector3d maximum_corner = Eigen::Vector3d::Constant(1e6);
};

}  // namespace wiimote_tracker::tracking
