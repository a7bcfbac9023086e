#include "wiimote_tracker_calibration/bundle/error.h"
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
  std::vector<geometry::Camera> cameras;
  for (const RecordedCamera& recorded : recording.cameras) {
    geometry::Camera camera;
    camera.name = recorded.name;
    camera.intrinsics.width = recorded.intrinsics.width;
    camera.intrinsics.height = recorded.intrinsics.height;
    cameras.push_back(camera);
  }
  std::vector<bundle::Observation> observations;
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      if (recording.frames[frame][i])
        observations.push_back({i, frame, *recording.frames[frame][i]});
    }
  }
  const bundle::SelfCalibrationOptions options;
  const bundle::SelfCalibration solution =
      bundle::selfCalibrate(cameras, observations, recording.frames.size(), options);
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
}

}  // namespace
}  // namespace wiimote_tracker::import
