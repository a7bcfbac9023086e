#include "ray_agreement.h"

#include "camera_records.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kMemory = 3.0;  // spots of one camera

// Distances of two lights are uniform over what the gate of track initiation allows by default
// [px]: from -sqrt(30) to sqrt(30) times 4 px (maximum_pair_chi_squared, birth_pixel_stddev).
constexpr double kRange = 44.0;

constexpr double kCorrelationTime = 0.2;  // of distances [s]

// Bounds of the log odds, so that a track can change its mind within a second.
constexpr double kLeast = -20.0;
constexpr double kMost = 10.0;

/// The distance of two rays of one track from each other, positive or negative, over the standard
/// deviation that a pixel error of 1 px in each camera causes: of an LED, an error in pixels.
/// Motion that the predictions did not expect moves both rays alike and does not count.
double distanceOf(const RayOffset& a, const RayOffset& b) {
  constexpr double kLeastSine = 0.05;  // of rays with a common normal
  const Eigen::Vector3d difference = a.offset - b.offset;
  const Eigen::Vector3d normal = a.direction.cross(b.direction);
  const double sine = normal.norm();
  const double distance = sine < kLeastSine ? difference.norm() : normal.dot(difference) / sine;
  return distance / std::hypot(a.scale, b.scale);
}

/// Standard deviation of this distance by the noise of both cameras [px].
double stddevOf(const RayOffset& a, const RayOffset& b) {
  return std::hypot(a.scale * a.pixel_stddev, b.scale * b.pixel_stddev) /
         std::hypot(a.scale, b.scale);
}

}  // namespace

void RayOffset::add(const RayOffset& spot) {
  count = std::min(count + 1.0, kMemory);
  offset += (spot.offset - offset) / count;
  direction = spot.direction;
  scale = spot.scale;
  pixel_stddev = spot.pixel_stddev;
}

/// Where a third camera sees the LED too, the rays meet.
void RayAgreement::update(const Visibility& now, double pixel_stddev, double time) {
  const auto [a, b] = now.rays;
  if (now.detected > 2)
    weigh(0.0, pixel_stddev, time);
  else if (now.detected == 2 && a->count > 0.0 && b->count > 0.0)
    weigh(distanceOf(*a, *b), stddevOf(*a, *b), time);
  else
    time_ = time;
}

/// @param distance of the rays [px] @param stddev of that of an LED's rays [px]
void RayAgreement::weigh(double distance, double stddev, double time) {
  const double normalized = distance / stddev;
  latest_ = std::log(kRange / (stddev * std::sqrt(2.0 * M_PI))) - 0.5 * normalized * normalized;
  const double elapsed = std::max(time - time_, 0.0);
  log_odds_ = std::clamp(log_odds_ + latest_ * elapsed / kCorrelationTime, kLeast, kMost);
  time_ = time;
}

void RayAgreement::reacquire() {
  constexpr double kReacquired = 3.0;  // 20 to 1
  log_odds_ = std::max(log_odds_, kReacquired);
}

}  // namespace wiimote_tracker::tracking
