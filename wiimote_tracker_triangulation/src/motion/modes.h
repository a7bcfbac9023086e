#pragma once

#include "motion/kinematic_state.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"

#include <Eigen/Core>

#include <array>

namespace wiimote_tracker::motion {

// The modes of MotionOptions: those at rest, then the moving ones by their agility.
constexpr int kRestModes = kRestModeNames.size();
constexpr int kSudden = kRestModes + kMovingModeNames.size();
constexpr int kModes = kSudden + 1;

inline bool isAtRest(int mode) {
  return mode < kRestModes;
}

/// One mode's probability, and the state of the LED if it is in this mode.
struct Mode {
  double probability;  // [0..1]; where it is 0, the state has no meaning
  KinematicState state;
};

using Modes = std::array<Mode, kModes>;

/// Of a new LED. @param position [m]  @param covariance [m^2]
Modes initialModes(const MotionOptions& options,
                   const Eigen::Vector3d& position,
                   const Eigen::Matrix3d& covariance);

/// Predicts a mode's state over a duration [s, >= 0].
void predict(const MotionOptions& options, int mode, double duration, KinematicState* state);

/// Variance of the acceleration with which a mode begins, per axis [m^2/s^4].
double accelerationVariance(const MotionOptions& options, int mode);

/// Mean and covariance of the mixture of all modes.
KinematicState momentsOf(const Modes& modes);

/// The interaction (mixing) step by the changes from moving modes to those at rest over a duration
/// [s]: each mode's state becomes the mean and covariance of the mixture of all modes' states,
/// weighted by their mixing probabilities. A mode at rest mixes positions only.
void mixStops(const MotionOptions& options, double duration, Modes* modes);

/// The same by all other changes: from rest to moving modes, and among these. States that enter a
/// moving mode from a less agile one get its variance of acceleration.
void mixChanges(const MotionOptions& options, double duration, Modes* modes);

}  // namespace wiimote_tracker::motion
