#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_MOTION_MOTION_STEPS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_MOTION_MOTION_STEPS_H

#include "wiimote_tracker_triangulation/motion/kinematic_states.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"

namespace wiimote_tracker::motion {

/// What passes over a duration [s, > 0] in each way to move: smooth, gentle, brisk, sudden.
KinematicSteps motionSteps(const MotionOptions& options, double duration);

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_MOTION_MOTION_STEPS_H
