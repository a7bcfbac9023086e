#include "clock_lag.h"

#include "capture/image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace wiimote_tracker::samples {

namespace {

constexpr double kStep = 0.02;             // [s]
constexpr int kLongestLag = 150;           // [kStep]
constexpr double kLeastCorrelation = 0.2;  // mean over the other cameras
constexpr std::size_t kLeastCommon = 100;  // of the steps of two cameras

/// Logarithm of the spot's speed, less its mean, in steps of time; NaN where unknown or where the
/// spot jumps, as a false detection does.
std::vector<double> logSpeeds(const wave::CameraRecording& camera,
                              double start,
                              std::size_t steps) {
  std::vector<double> result(steps, std::numeric_limits<double>::quiet_NaN());
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 1; i < camera.frames.size(); ++i) {
    const wave::Frame& before = camera.frames[i - 1];
    const wave::Frame& after = camera.frames[i];
    const double step = std::floor((after.stamp - start) / kStep);
    const double gap = after.stamp - before.stamp;
    if (before.spots.size() != 1 || after.spots.size() != 1 || gap > capture::kLongestGap ||
        step < 0.0 || step >= static_cast<double>(steps))
      continue;
    const double distance = (after.spots[0] - before.spots[0]).norm();
    if (distance > capture::kLongestJump)
      continue;
    const double speed = std::log(1.0 + distance / gap);
    result[static_cast<std::size_t>(step)] = speed;
    sum += speed;
    count += 1.0;
  }
  for (double& speed : result)
    speed -= sum / count;
  return result;
}

/// Correlation of two signals, the first moved to earlier times by `lag` steps, times the
/// root of their common share: few common steps correlate by chance.
double correlation(const std::vector<double>& late, const std::vector<double>& other, int lag) {
  double product = 0.0;
  double squares = 0.0;
  double other_squares = 0.0;
  std::size_t common = 0;
  const int size = static_cast<int>(late.size());
  for (int i = std::max(0, lag); i < std::min(size, size + lag); ++i) {
    const double a = late[static_cast<std::size_t>(i)];
    const double b = other[static_cast<std::size_t>(i - lag)];
    if (std::isnan(a) || std::isnan(b))
      continue;
    product += a * b;
    squares += a * a;
    other_squares += b * b;
    ++common;
  }
  const double scale = std::sqrt(squares * other_squares);
  if (common < kLeastCommon || !(scale > 0.0))  // 0 where a spot stands still
    return 0.0;
  return product / scale * std::sqrt(static_cast<double>(common) / static_cast<double>(size));
}

}  // namespace

std::optional<double> clockLag(const wave::Recording& recording, std::size_t camera) {
  if (recording.cameras[camera].frames.empty())
    return std::nullopt;
  const auto [start, end] = recording.span();
  const auto steps = static_cast<std::size_t>((end - start) / kStep) + 1;
  const std::vector<double> own = logSpeeds(recording.cameras[camera], start, steps);
  std::vector<std::vector<double>> others;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    if (i != camera && !recording.cameras[i].frames.empty())
      others.push_back(logSpeeds(recording.cameras[i], start, steps));
  }
  double best = kLeastCorrelation * static_cast<double>(others.size());
  std::optional<double> result;
  for (int lag = -kLongestLag; lag <= kLongestLag; ++lag) {
    double sum = 0.0;
    for (const std::vector<double>& other : others)
      sum += correlation(own, other, lag);
    if (sum > best) {
      best = sum;
      result = kStep * lag;
    }
  }
  return result;
}

}  // namespace wiimote_tracker::samples
