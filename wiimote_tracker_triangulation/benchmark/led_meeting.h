#pragma once

#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <optional>
#include <vector>

namespace wiimote_tracker {

/// Two LEDs that pass each other in the middle of the paper's cube so closely that their spots
/// merge in all views. Each LED's acceleration is a first-order Markov process (Singer).
struct LedMeeting {
  double acceleration = 2.0;       ///< Standard deviation per axis, of each LED [m/s^2].
  double acceleration_time = 0.5;  ///< Autocorrelation time of the acceleration [s].
  double relative_speed = 0.5;     ///< Standard deviation per axis at the meeting [m/s].
  double half_duration = 1.0;      ///< Simulated before the meeting, and after it [s].
  double meeting_time = 1001.0;    ///< [s]

  /// The paths of both LEDs.
  std::vector<tracking::test::Path> draw(geometry::test::Random& random) const;
};

/// A meeting as cameras saw it.
struct MeetingFilm {
  const geometry::Rig& rig;
  const std::vector<tracking::test::Path>& leds;
  const std::vector<tracking::test::SceneImage>& images;
  double pixel_stddev;  ///< [px]
};

/// Whether an oracle confuses the two LEDs: whether the spots are more likely with the LEDs
/// exchanged after the meeting than without. The oracle knows the motion model, the cameras' noise,
/// all images, and before and after the meeting which spots are of one LED; its Kalman filters are
/// linearised at the truth.
struct OracleErrors {
  bool with_model;
  bool with_filters;  ///< With the tracker's filters instead of the true motion model.
};

/// Nothing when the spots were never merged in all views.
std::optional<OracleErrors> oracleErrors(const LedMeeting& meeting, const MeetingFilm& film);

}  // namespace wiimote_tracker
