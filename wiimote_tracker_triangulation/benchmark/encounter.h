#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_ENCOUNTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_ENCOUNTER_H

#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker {

/// Two LEDs that meet in the middle of the paper's cube so closely that all views show one spot,
/// and part again. Each one's acceleration is a first-order Markov process of its own (Singer).
struct Encounter {
  double acceleration = 2.0;       ///< Standard deviation per axis, of each LED [m/s^2].
  double acceleration_time = 0.5;  ///< After which it is forgotten [s].
  double relative_speed = 0.5;     ///< Standard deviation per axis at the meeting [m/s].
  double half_duration = 1.0;      ///< Simulated before the meeting, and after it [s].
  double meeting_time = 1001.0;    ///< [s]

  /// The paths of both.
  std::vector<tracking::test::Path> draw(geometry::test::Random& random) const;
};

/// Whether somebody who knows the model of motion, the cameras' noise, all images before and after
/// the meeting, and on either side of it which spots are of one LED, would rather take the LEDs for
/// exchanged: the likelihood of all spots with and without the exchange, by Kalman filters that are
/// linearised at the truth. Nothing when they were never one spot in all views.
std::optional<bool> oracleErrs(const Encounter& encounter,
                               const geometry::Rig& rig,
                               const std::vector<tracking::test::Path>& leds,
                               const std::vector<tracking::test::SceneImage>& images,
                               double pixel_stddev);

/// The same, for somebody who knows all that but the model of motion, and follows the LEDs with the
/// tracker's filters instead.
std::optional<bool> oracleErrsWithFilters(const motion::MotionOptions& options,
                                          const geometry::Rig& rig,
                                          const std::vector<tracking::test::Path>& leds,
                                          const std::vector<tracking::test::SceneImage>& images,
                                          double pixel_stddev);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_ENCOUNTER_H
