#pragma once

#include <array>

namespace wiimote_tracker::motion {

/// A mode at rest: the position is a random walk.
struct RestMode {
  double drift;       ///< Density of the random walk [m/sqrt(s), >= 0].
  double start_rate;  ///< Transition rate to the moving modes [1/s, >= 0].
};

/// A moving mode: the acceleration is a first-order Markov process in each axis (Singer 1970).
struct SingerMode {
  double stddev;  ///< Standard deviation of the acceleration [m/s^2, > 0].
  double time;    ///< Autocorrelation time of the acceleration [s, > 0].
};

/// Names of the modes in the parameters, in the order of MotionOptions.
constexpr std::array<const char*, 2> kRestModeNames = {"fixed", "swaying"};
constexpr std::array<const char*, 4> kMovingModeNames = {"smooth", "gentle", "brisk", "hard"};

/// The modes of the filter and the rates at which an LED changes between them. The moving modes are
/// in the order of their agility; the sudden one is the most agile. Tuned: see doc/motion.md.
struct MotionOptions {
  std::array<RestMode, kRestModeNames.size()> rest{{
      {5e-5, 0.2},  // fixed: an LED that lies or stands on something
      {4e-3, 1.2},  // swaying: one that a person holds still, or on a foot that stands
  }};
  std::array<SingerMode, kMovingModeNames.size()> moving{{
      {0.0003, 20.0},  // smooth: nearly constant acceleration, turning or swinging freely
      {0.5, 8.0},      // gentle: a hand that is moved with care
      {4.0, 0.2},      // brisk: a hand that gestures
      {20.0, 0.15},    // hard: a hand that strikes or shakes
  }};

  /// Mode of nearly constant velocity, for LEDs that are thrown or bump into something: density of
  /// the random walk of the velocity [m/s/sqrt(s), >= 0]; 0: without this mode.
  double sudden_random_walk = 3.3;

  double stop_rate = 0.1;       ///< From a moving mode to rest, in equal parts to the modes at
                                ///< rest [1/s, >= 0]; 0: without the modes at rest.
  double rise_rate = 2.4;       ///< From a moving mode to the more agile ones [1/s, >= 0].
  double settle_rate = 0.0008;  ///< From a moving mode to the less agile ones [1/s, >= 0].
  double initial_speed = 2.0;   ///< Standard deviation of a new LED's velocity, per axis
                                ///< [m/s, > 0].
};

}  // namespace wiimote_tracker::motion
