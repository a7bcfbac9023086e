// What the tests of InstantFuser share: a rig, a path, and comparisons.
#ifndef WIIMOTE_TRACKER_TRIANGULATION_TEST_FUSION_INSTANTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_TEST_FUSION_INSTANTS_H

#include "fusion/film.h"
#include "geometry/random_rigs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::fusion::test {

inline geometry::Rig threeCameras() {
  geometry::test::Random random(51);
  return geometry::test::randomRig(random, 3);
}

inline void expectIncreasing(const std::vector<tracking::Snapshot>& instants) {
  for (std::size_t i = 1; i < instants.size(); ++i)
    ASSERT_GT(instants[i].time, instants[i - 1].time);
}

inline std::uint64_t lateImages(const InstantFuser& fuser) {
  return fuser.counters().late + fuser.counters().repeated;
}

/// 1 m/s on a circle of 0.5 m.
inline Eigen::Vector3d circle(double t) {
  return {0.5 * std::cos(2.0 * t), 0.5 * std::sin(2.0 * t), 0.2};
}

}  // namespace wiimote_tracker::fusion::test

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TEST_FUSION_INSTANTS_H
