#include "reacquisition.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::tracking {

/// Not eligible is a track that has been seen beside the new one or by more cameras since; one that
/// a MergedPair is about to decide; or one of a blinking LED that may be dark. The LED may have
/// moved as no mode describes, as when it is caught, or its track may have followed a false
/// detection: initial_speed allows for that.
Track* reacquiredBy(const Track& track, const TrackerOptions& options, GroupState* state) {
  constexpr double kEver = -std::numeric_limits<double>::infinity();
  const double time = track.filter().time();
  const double since = track.startedAt();
  Track* result = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Track& known : state->tracks) {
    const auto decidesIt = [&](const MergedPair& pair) {
      return pair.areSeparate(time) && pair.has(known.id());
    };
    if (&known == &track || !known.isConfirmed() ||
        time - known.lastObserved() < options.dark_time ||
        known.cameras().showing(since) > track.cameras().showing(since) ||
        known.cameras().showBeside(track.cameras(), kEver) ||
        std::any_of(state->pairs.begin(), state->pairs.end(), decidesIt))
      continue;
    motion::MotionFilter expected = known.filter();
    expected.predict(time);
    const double slack = options.motion.initial_speed * (time - known.lastObserved());
    const Eigen::Matrix3d covariance = expected.positionCovariance() +
                                       track.filter().positionCovariance() +
                                       slack * slack * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d offset = track.filter().position() - expected.position();
    const double distance = offset.dot(covariance.inverse() * offset);
    const double cost = distance + std::log(covariance.determinant());  // -2 log likelihood
    if (distance <= options.gate && cost < least) {
      least = cost;
      result = &known;
    }
  }
  return result;
}

}  // namespace wiimote_tracker::tracking
