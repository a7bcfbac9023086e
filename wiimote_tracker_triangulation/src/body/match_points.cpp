#include "body/match_points.h"

#include "body/align.h"

#include <cmath>

namespace wiimote_tracker::body {

bool isSamePose(const std::vector<Eigen::Vector3d>& leds,
                const Eigen::Isometry3d& a,
                const Eigen::Isometry3d& b) {
  for (std::size_t i = 0; i < leds.size(); ++i) {
    if ((a * leds[i] - b * leds[i]).norm() > 0.5 * distanceToNearest(leds, i))
      return false;
  }
  return true;
}

namespace {

constexpr double kUnseenCost = 25.0;  // of an LED without a point [chi^2]
constexpr double kGate = 4.0;         // of a distance between two LEDs [standard deviations]
constexpr std::size_t kFewestLeds = 3;

/// Depth-first search: each LED takes a point consistent with those before it, or none.
class MatchSearch {
 public:
  MatchSearch(const Constellation& constellation, const std::vector<MeasuredPoint>& points)
      : leds_(constellation.leds), points_(points) {
    chosen_.fill(kUnseen);
  }

  std::optional<Match> run() {
    extend(0, 0);
    if (!found_)
      return std::nullopt;
    best_.margin = runner_up_cost_ - best_cost_;
    return best_;
  }

 private:
  void extend(std::size_t led, std::size_t seen) {
    if (led == leds_.size()) {
      if (seen >= kFewestLeds)
        judge(seen);
      return;
    }
    const std::size_t left = leds_.size() - led;
    const double unseen = (led - seen) * kUnseenCost;
    // Costlier branches than the runner-up change nothing.
    if (seen + left < kFewestLeds || unseen > runner_up_cost_)
      return;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      if (points_[p].taken || !agrees(led, p))
        continue;
      chosen_[led] = static_cast<int>(p);
      extend(led + 1, seen + 1);
    }
    chosen_[led] = kUnseen;
    extend(led + 1, seen);
  }

  bool agrees(std::size_t led, std::size_t p) const {
    for (std::size_t other = 0; other < led; ++other) {
      if (chosen_[other] == kUnseen)
        continue;
      const std::size_t q = chosen_[other];
      if (q == p)
        return false;
      const double difference =
          (leds_[led] - leds_[other]).norm() - (points_[p].position - points_[q].position).norm();
      if (std::abs(difference) > kGate * std::hypot(points_[p].stddev, points_[q].stddev))
        return false;
    }
    return true;
  }

  void judge(std::size_t seen) {
    std::array<PointPair, kMaximumLeds> pairs;
    std::size_t count = 0;
    for (std::size_t led = 0; led < leds_.size(); ++led) {
      if (chosen_[led] == kUnseen)
        continue;
      const MeasuredPoint& point = points_[chosen_[led]];
      pairs[count++] = {leds_[led], point.position, 1.0 / (point.stddev * point.stddev)};
    }
    const Alignment alignment = align(pairs.data(), count);
    // Distances that agree by chance, as of a mirrored body.
    if (alignment.cost > count * kGate * kGate)
      return;
    const double cost = alignment.cost + (leds_.size() - seen) * kUnseenCost;
    if (cost < best_cost_) {
      // A match of the same pose with one LED more or less is not a rival.
      if (found_ && !isSamePose(leds_, best_.world_from_body, alignment.world_from_body))
        runner_up_cost_ = best_cost_;
      found_ = true;
      best_cost_ = cost;
      best_.point_of_led = chosen_;
      best_.world_from_body = alignment.world_from_body;
    } else if (cost < runner_up_cost_ &&
               !isSamePose(leds_, best_.world_from_body, alignment.world_from_body)) {
      runner_up_cost_ = cost;
    }
  }

  const std::vector<Eigen::Vector3d>& leds_;
  const std::vector<MeasuredPoint>& points_;
  std::array<int, kMaximumLeds> chosen_;
  bool found_ = false;
  Match best_;
  double best_cost_ = std::numeric_limits<double>::infinity();
  double runner_up_cost_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::optional<Match> matchPoints(const Constellation& constellation,
                                 const std::vector<MeasuredPoint>& points) {
  return MatchSearch(constellation, points).run();
}

}  // namespace wiimote_tracker::body
