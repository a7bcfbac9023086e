#pragma once

#include <cstddef>
#include <cstdint>

namespace wiimote_tracker {

/// What happens to a well calibrated rig after 20 s of tracking.
struct Knock {
  double turn = 0.0;        ///< About any axis through a camera's centre [rad].
  std::size_t knocked = 1;  ///< Cameras.
  double pause = 0.0;       ///< From one of them to the next [s].
  bool together = false;    ///< They stand on one shelf, which turns about the middle between them.
  std::size_t cameras = 4;  ///< Of the rig.
  /// Of several, a camera does not see one in 10 % of the half seconds; 5 % false detections.
  std::size_t leds = 1;
  bool on_body = false;  ///< The LEDs are those of one body.
};

struct KnockTrial {
  bool found = false;    ///< All knocked cameras were solved.
  bool others = false;   ///< Another camera was changed before.
  double seconds = 0.0;  ///< From the last knock until all were found.
  double error = 0.0;    ///< RMS error of the volume then, or at the end [m].
};

/// Applies every proposal but those of drift, as by the policy `knocked`, for a minute after the
/// last knock, with the LEDs of a body two, or until all are found.
KnockTrial runKnockTrial(const Knock& knock, std::uint64_t seed);

}  // namespace wiimote_tracker
