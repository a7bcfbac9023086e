#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_STEPS_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_STEPS_H

#include "wiimote_tracker_triangulation/motion/kinematic_states.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"

namespace wiimote_tracker::motion {

/// What passes over a duration in each way to move: smooth, gentle, brisk, sudden. Remembers the
/// last one, since all LEDs before a camera mostly go on by the same.
class MotionSteps {
 public:
  explicit MotionSteps(const MotionOptions& options) : options_(options) {}

  /// Over a duration [s, > 0]; valid until the next call.
  const KinematicSteps& over(double duration);

 private:
  MotionOptions options_;
  double duration_ = 0.0;  // of steps_; 0: there are none yet
  KinematicSteps steps_;
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_STEPS_H
