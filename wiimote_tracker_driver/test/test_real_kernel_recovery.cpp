// The criteria of the scenarios with a real kernel.
#include "../real_kernel/guest/recovery.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::real_kernel {
namespace {

/// Appends `count` images at `rate` [Hz], the first at `begin` [s].
void append(std::vector<double>& images, double begin, double rate, int count) {
  for (int i = 0; i < count; ++i)
    images.push_back(begin + i / rate);
}

TEST(RecoveryTime, OfAnUndisturbedStreamIsTheTimeToTheNextImage) {
  std::vector<double> images;
  append(images, 0.0, 100.0, 300);
  EXPECT_NEAR(0.005, recoveryTime(images, 1.005), 1e-9);
}

TEST(RecoveryTime, IsTheLengthOfAPause) {
  std::vector<double> images;
  append(images, 0.0, 100.0, 100);
  append(images, 1.6, 100.0, 100);
  EXPECT_NEAR(0.6, recoveryTime(images, 1.0), 1e-9);
}

TEST(RecoveryTime, CountsNoImagesFromBefore) {
  std::vector<double> images;
  append(images, 0.0, 100.0, 100);
  append(images, 1.6, 100.0, 50);
  EXPECT_LT(recoveryTime(images, 1.0), 0.0);
}

TEST(RecoveryTime, FewImagesBetweenTwoPausesAreNoRecovery) {
  std::vector<double> images;
  append(images, 1.0, 100.0, 20);
  append(images, 1.8, 100.0, 20);
  append(images, 2.5, 100.0, 100);
  EXPECT_NEAR(1.5, recoveryTime(images, 1.0), 1e-9);
}

TEST(RecoveryTime, NeedsNinetyImagesASecond) {
  std::vector<double> images;
  append(images, 0.0, 88.5, 1000);
  EXPECT_LT(recoveryTime(images, 0.0), 0.0);
  images.clear();
  append(images, 0.0, 90.0, 1000);
  EXPECT_EQ(0.0, recoveryTime(images, 0.0));
}

TEST(RecoveryTime, OrAnotherRate) {
  std::vector<double> images;
  append(images, 0.0, 43.5, 1000);
  EXPECT_LT(recoveryTime(images, 0.0, 45.0), 0.0);
  images.clear();
  append(images, 0.0, 45.0, 1000);
  EXPECT_EQ(0.0, recoveryTime(images, 0.0, 45.0));
}

TEST(RecoveryTime, WithoutImagesThereIsNone) {
  EXPECT_LT(recoveryTime({}, 0.0), 0.0);
}

TEST(LongestPause, BeginsBeforeTheFirstImageAndEndsAtTheLast) {
  const std::vector<double> images{0.1, 1.5, 1.6, 1.9, 9.0};
  EXPECT_NEAR(0.5, longestPause(images, 1.0, 2.0), 1e-9);
  EXPECT_NEAR(0.3, longestPause(images, 1.4, 2.0), 1e-9);
  EXPECT_EQ(0.0, longestPause({}, 1.0, 2.0));
}

TEST(ImagesBetween, CountsThoseAtBothEnds) {
  const std::vector<double> images{0.1, 1.5, 1.6, 1.9, 9.0};
  EXPECT_EQ(3u, imagesBetween(images, 1.5, 1.9));
  EXPECT_EQ(0u, imagesBetween(images, 2.0, 8.0));
  EXPECT_EQ(0u, imagesBetween({}, 1.0, 2.0));
}

}  // namespace
}  // namespace wiimote_tracker::real_kernel
