#include "wiimote_tracker_calibration/bundle/self_calibrate.h"
#include "wiimote_tracker_calibration/import/comparison.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::import {
namespace {

TEST(SelfCalibrateExcerpt, isNoWorseThanFlydrasCalibration) {
  const Recording recording = readRecording(FLYDRA_EXCERPT);
  bundle::Reconstruction observed = observedBy(recording);
  for (geometry::Camera& camera : observed.cameras) {
    geometry::Intrinsics unknown;
    unknown.width = camera.intrinsics.width;
    unknown.height = camera.intrinsics.height;
    camera.intrinsics = unknown;
  }
  const bundle::SelfCalibrationOptions options;
  const bundle::SelfCalibration solution = bundle::selfCalibrate(observed, options);
  const auto comparison = compare(recording, solution, options.bundle);
  ASSERT_TRUE(comparison);
  ASSERT_EQ(comparison->own.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    SCOPED_TRACE(recording.cameras[i].name);
    EXPECT_GE(comparison->own[i].inliers, comparison->shipped[i].inliers);
    EXPECT_LE(comparison->own[i].median, comparison->shipped[i].median);
    EXPECT_LE(comparison->own[i].mean, comparison->shipped[i].mean);
    EXPECT_LE(comparison->own[i].p95, comparison->shipped[i].p95);
  }
  // Flydra's pixels have skew, which ours do not: this is the effect on the points.
  EXPECT_LT(comparison->similar.median, 0.01 * comparison->extent);
  // A projective transformation makes up for most of it.
  EXPECT_LT(comparison->projective.rms, 0.5 * comparison->similar.rms);
}

}  // namespace
}  // namespace wiimote_tracker::import
