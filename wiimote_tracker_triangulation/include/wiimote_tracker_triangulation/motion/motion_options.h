#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_OPTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_OPTIONS_H

namespace wiimote_tracker::motion {

/// A way to rest: the position is a random walk.
struct Resting {
  double drift;       ///< Random walk of the position [m/sqrt(s), >= 0].
  double start_rate;  ///< How often it starts to move [1/s, >= 0].
};

/// A way to move: the acceleration wanders about zero, in each axis on its own (Singer 1970).
struct Wandering {
  double stddev;  ///< Standard deviation of the acceleration [m/s^2, > 0].
  double time;    ///< After which it is alike to 1/e [s, > 0].
};

/// How LEDs move. An LED rests in one of two ways or moves in one of four, and changes between
/// these six at random times. How fast it goes makes no difference, only how it changes.
struct MotionOptions {
  Resting fixed{5e-5, 0.2};         ///< What lies or stands on something.
  Resting swaying{4e-3, 1.2};       ///< What people hold still, or a foot that they stand on.
  Wandering smooth{0.0003, 20.0};   ///< All but constant acceleration: what turns or swings freely.
  Wandering gentle{0.5, 8.0};       ///< A hand that is led with care.
  Wandering brisk{4.0, 0.2};        ///< A hand that gestures.
  double sudden_random_walk = 3.3;  ///< Of the velocity, of what is thrown about and bumps into
                                    ///< things [m/s/sqrt(s), >= 0]; 0: nothing is.
  double stop_rate = 0.1;       ///< How often what moves comes to rest, one way or the other alike
                                ///< [1/s, >= 0]; 0: nothing rests.
  double rise_rate = 2.4;       ///< How often it changes to one of the rasher ways [1/s, >= 0].
  double settle_rate = 0.0008;  ///< How often to one of the calmer ways [1/s, >= 0].
  double initial_speed = 1.0;   ///< Standard deviation per axis of a new LED [m/s, > 0].
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_OPTIONS_H
