#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_OPTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_OPTIONS_H

namespace wiimote_tracker::motion {

/// How LEDs move. An LED is still, or moves gently, or briskly, and changes between the three at
/// random times. Moving, its acceleration wanders about zero: normal in each axis, of a standard
/// deviation that tells gentle from brisk, forgotten over acceleration_time (Singer 1970).
struct MotionOptions {
  double gentle_acceleration = 1.0;  ///< Standard deviation per axis [m/s^2, > 0].
  double brisk_acceleration = 15.0;  ///< Standard deviation per axis [m/s^2, >= gentle].
  double acceleration_time = 0.3;    ///< After which accelerations are alike to 1/e [s, > 0].
  double still_drift = 2e-5;         ///< Random walk of an LED that is still [m/sqrt(s), >= 0].
  double start_rate = 1.0;           ///< Of an LED that is still to move [1/s, >= 0].
  double stop_rate = 1.0;            ///< Of one that moves to be still [1/s, >= 0]; 0: never is.
  double change_rate = 5.0;          ///< Between gentle and brisk, each way [1/s, >= 0].
  double initial_speed = 1.0;        ///< Standard deviation per axis of a new LED [m/s, > 0].
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_OPTIONS_H
