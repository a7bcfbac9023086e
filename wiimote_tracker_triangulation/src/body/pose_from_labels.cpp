#include "body/align.h"
#include "body/body_tracker.h"
#include "pixel_update.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <optional>

namespace wiimote_tracker::body {
namespace {

// Greatest mean squared residual per coordinate [variances]: refuses wrong labels.
constexpr double kWorst = 9.0;
constexpr double kMotion = 0.002;  // of the LEDs between the images of the points [m]

/// The pose of a body from labelled points. Nothing when fewer than three of its LEDs are among
/// them, or they lie on a line or do not agree with the constellation.
std::optional<BodyPose> poseFromLabels(const Constellation& constellation,
                                       const std::vector<LabelledPoint>& points) {
  std::array<PointPair, kMaximumLeds> pairs;
  std::array<Eigen::Matrix3d, kMaximumLeds> information;
  std::size_t count = 0;
  for (std::size_t led = 0; led < constellation.leds.size(); ++led) {
    const auto point =
        std::find_if(points.begin(), points.end(), [&](const LabelledPoint& candidate) {
          return candidate.label == constellation.labels[led];
        });
    if (point == points.end())
      continue;
    const Eigen::Matrix3d covariance =
        point->covariance + kMotion * kMotion * Eigen::Matrix3d::Identity();
    information[count] = covariance.inverse();
    pairs[count++] = {constellation.leds[led], point->position, 3.0 / covariance.trace()};
  }
  if (count < 3)
    return std::nullopt;
  const Alignment alignment = align(pairs.data(), count);
  if (alignment.cost > kWorst * 3 * count)
    return std::nullopt;

  PoseCovariance normal = PoseCovariance::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Matrix<double, 3, 6> jacobian =
        pointByPose(alignment.world_from_body.linear() * pairs[i].in_body);
    normal += jacobian.transpose() * information[i] * jacobian;
  }
  const Eigen::LLT<PoseCovariance> factor(normal);
  if (factor.info() != Eigen::Success || factor.rcond() < 1e-12)
    return std::nullopt;
  return BodyPose{alignment.world_from_body, factor.solve(PoseCovariance::Identity())};
}

}  // namespace

void BodyTracker::startFromLabels(const std::vector<LabelledPoint>& points) {
  auto& images = history_.images();
  if (images.empty())
    return;
  BodyImage& newest = images.at(images.end() - 1);
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    const Constellation& constellation = setup_.bodies[b].constellation;
    if (state_.bodies[b] || constellation.labels.empty())
      continue;
    if (const auto pose = poseFromLabels(constellation, points)) {
      state_.bodies[b].emplace(setup_.options, newest.time, *pose, 0);
      newest.starts.push_back({b, *pose});  // for when a late image undoes this one
    }
  }
  estimate();
}

}  // namespace wiimote_tracker::body
