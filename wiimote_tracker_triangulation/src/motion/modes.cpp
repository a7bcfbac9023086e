#include "motion/modes.h"

#include "motion/transition.h"

#include <iterator>

namespace wiimote_tracker::motion {
namespace {

double square(double x) {
  return x * x;
}

/// One past the last mode: the sudden one may be left out.
int endOf(const MotionOptions& options) {
  return options.sudden_random_walk > 0.0 ? kModes : kSudden;
}

/// Null for the other modes.
const SingerMode* singerMode(const MotionOptions& options, int mode) {
  return isAtRest(mode) || mode == kSudden ? nullptr : &options.moving[mode - kRestModes];
}

/// From each mode (row) to another (column): rates [1/s] or probabilities.
using ModeTransitions = Eigen::Matrix<double, kModes, kModes>;

/// Probabilities over a duration h from rates r [1/s]: r h / (1 + sum(r) h) for each change, the
/// rest for none. This is exp(R h) to first order, but never outside of [0, 1].
ModeTransitions probabilities(const ModeTransitions& rates, double duration) {
  ModeTransitions result;
  for (int i = 0; i < kModes; ++i) {
    const double all = rates.row(i).sum() * duration;
    result.row(i) = rates.row(i) * (duration / (1.0 + all));
    result(i, i) = 1.0 / (1.0 + all);
  }
  return result;
}

/// Mean and covariance of a mixture, of the first N components of the state; the others are zero.
/// @param weights add up to 1; states of weight 0 have no part
template <int N>
KinematicState mixture(const Eigen::Matrix<double, kModes, 1>& weights, const Modes& modes) {
  KinematicState result;
  result.mean.setZero();
  result.covariance.setZero();
  for (int i = 0; i < kModes; ++i) {
    if (weights[i] > 0.0)
      result.mean.head<N>() += weights[i] * modes[i].state.mean.head<N>();
  }
  for (int i = 0; i < kModes; ++i) {
    if (!(weights[i] > 0.0))
      continue;
    const KinematicState& state = modes[i].state;
    const Eigen::Matrix<double, N, 1> d = state.mean.head<N>() - result.mean.head<N>();
    const Eigen::Matrix<double, N, 1> weighted = weights[i] * d;
    result.covariance.topLeftCorner<N, N>() +=
        weights[i] * state.covariance.topLeftCorner<N, N>() + weighted.lazyProduct(d.transpose());
  }
  return result;
}

void mix(const ModeTransitions& transitions, const MotionOptions& options, Modes* modes) {
  const Modes before = *modes;
  for (int j = 0; j < kModes; ++j) {
    Eigen::Matrix<double, kModes, 1> weights;
    double less_agile = 0.0;  // probability of entering from these
    for (int i = 0; i < kModes; ++i) {
      weights[i] = transitions(i, j) * before[i].probability;
      if (i < j)
        less_agile += weights[i];
    }
    Mode& mode = (*modes)[j];
    mode.probability = weights.sum();
    if (mode.probability == weights[j])
      continue;  // nothing enters
    weights /= mode.probability;
    if (isAtRest(j)) {
      mode.state = mixture<3>(weights, before);  // of the positions
      continue;
    }
    mode.state = mixture<9>(weights, before);
    mode.state.covariance.diagonal().tail<3>().array() +=
        less_agile / mode.probability * accelerationVariance(options, j);
  }
}

}  // namespace

Modes initialModes(const MotionOptions& options,
                   const Eigen::Vector3d& position,
                   const Eigen::Matrix3d& covariance) {
  const int moving = endOf(options) - kRestModes;
  // The modes at rest together are as likely as one moving mode.
  const double at_rest = options.stop_rate > 0.0 ? 1.0 / (moving + 1) : 0.0;
  Modes modes;
  for (int i = 0; i < kModes; ++i) {
    Mode& mode = modes[i];
    mode.probability = isAtRest(i)          ? at_rest / kRestModes
                       : i < endOf(options) ? (1.0 - at_rest) / moving
                                            : 0.0;
    mode.state.mean << position, Eigen::Matrix<double, 6, 1>::Zero();
    mode.state.covariance.setZero();
    mode.state.covariance.topLeftCorner<3, 3>() = covariance;
    if (isAtRest(i))
      continue;
    mode.state.covariance.diagonal().segment<3>(3).setConstant(square(options.initial_speed));
    mode.state.covariance.diagonal().tail<3>().setConstant(accelerationVariance(options, i));
  }
  return modes;
}

void predict(const MotionOptions& options, int mode, double duration, KinematicState* state) {
  if (isAtRest(mode)) {  // velocity and acceleration are zero
    state->covariance.diagonal().head<3>().array() += square(options.rest[mode].drift) * duration;
  } else if (const SingerMode* moving = singerMode(options, mode)) {
    state->predict(singer(moving->stddev, moving->time, duration));
  } else {
    state->predict(randomWalkOfVelocity(options.sudden_random_walk, duration));
  }
}

double accelerationVariance(const MotionOptions& options, int mode) {
  const SingerMode* moving = singerMode(options, mode);
  return moving ? square(moving->stddev) : 0.0;
}

KinematicState momentsOf(const Modes& modes) {
  Eigen::Matrix<double, kModes, 1> weights;
  for (int i = 0; i < kModes; ++i)
    weights[i] = modes[i].probability;
  return mixture<9>(weights, modes);
}

void mixStops(const MotionOptions& options, double duration, Modes* modes) {
  ModeTransitions rates = ModeTransitions::Zero();
  for (int i = kRestModes; i < endOf(options); ++i)
    rates.row(i).head<kRestModes>().setConstant(options.stop_rate / kRestModes);
  mix(probabilities(rates, duration), options, modes);
}

void mixChanges(const MotionOptions& options, double duration, Modes* modes) {
  const int end = endOf(options);
  ModeTransitions rates = ModeTransitions::Zero();
  for (int from = 0; from < kRestModes; ++from) {
    for (int to = kRestModes; to < end; ++to)
      rates(from, to) = options.rest[from].start_rate / (end - kRestModes);
  }
  for (int from = kRestModes; from < end; ++from) {
    for (int to = kRestModes; to < from; ++to)
      rates(from, to) = options.settle_rate / (from - kRestModes);
    for (int to = from + 1; to < end; ++to)
      rates(from, to) = options.rise_rate / (end - 1 - from);
  }
  mix(probabilities(rates, duration), options, modes);
}

}  // namespace wiimote_tracker::motion
