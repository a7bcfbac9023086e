#ifndef WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TRACKER_OPTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TRACKER_OPTIONS_H

#include "wiimote_tracker_triangulation/motion/motion_options.h"

#include <Eigen/Core>

#include <cstddef>

namespace wiimote_tracker::tracking {

/// How spots become tracks. Ranges are those that make sense; what is outside is not checked here.
struct TrackerOptions {
  motion::MotionOptions motion;

  // What a camera does.
  double pixel_stddev = 0.5;           ///< Of each coordinate of a spot [px, 0.001..100].
  double stamp_stddev = 0.0005;        ///< Of images that do not say theirs [s, 0..0.1].
  double detection_probability = 0.9;  ///< That a camera shows an LED in its view [0.01..0.999].
  double ghost_rate = 0.5;             ///< Spots in an image that are no LED's, mean [0.001..16].
  double merging_distance = 24.0;      ///< LEDs closer than this may be one spot [px, 0..100].
  double maximum_range = 20.0;         ///< Cameras share no view beyond this [m, 0.1..1000].

  /// A spot further than this from an LED's prediction is not its: squared Mahalanobis distance
  /// [1, 4..100].
  double gate = 25.0;

  // The life of a track.
  double birth_window = 0.03;         ///< Of the images of a new LED [s, 0.001..0.2].
  double birth_pixel_stddev = 4.0;    ///< What motion within birth_window makes [px, 0.1..100].
  double minimum_angle = 0.02;        ///< Largest between the rays of a new LED [rad, 0.001..1].
  std::size_t confirmation_hits = 8;  ///< Images that must show a new LED [1..1000].
  double minimum_support = 0.5;       ///< Share of the cameras that ought to see it [0..1].
  double tracked_time = 0.05;         ///< Seen by two within this: tracked [s, 0.001..1].
  double prediction_time = 0.5;       ///< Unseen for longer, it is lost [s, 0.01..10].
  double doubt_time = 0.25;           ///< Of two that part, which is which, at most [s, 0..5].
  double single_view_time = 0.7;      ///< Seen by one camera only for longer: lost [s, 0.01..60].
  double dark_time = 0.0;  ///< LEDs that blink are dark for so long at most [s, 0..5]; 0: none does.

  /// No new LED outside this box: light mirrored by floors and windows seems to come from behind
  /// them [m].
  Eigen::Vector3d minimum_corner = Eigen::Vector3d::Constant(-1e6);
  Eigen::Vector3d maximum_corner = Eigen::Vector3d::Constant(1e6);

  // Time.
  double history = 0.2;          ///< Images later than this are dropped [s, 0.01..2].
  double output_interval = 0.0;  ///< No two snapshots closer than this [s, 0..1]; 0: every image.
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TRACKER_OPTIONS_H
