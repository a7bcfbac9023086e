#include "wiimote_tracker_calibration/square/suspect_corner.h"

#include <Eigen/LU>

#include <algorithm>
#include <vector>

namespace wiimote_tracker::square {

namespace {

// Exceeded by chance once in 10000 corners: -2 ln(1e-4).
constexpr double kDisplaced = 18.4;
// Share of a corner's prior variance that the rest must be able to take away.
constexpr double kLeastKnowledge = 0.01;

}  // namespace

std::optional<SuspectCorner> suspectCorner(const Corners& offsets,
                                           const Eigen::MatrixXd& joint_covariance,
                                           double placement) {
  const double variance = placement * placement;
  std::vector<SuspectCorner> suspects;
  for (std::size_t c = 0; c < offsets.size(); ++c) {
    const Eigen::Vector2d offset = offsets[c].head<2>();
    const Eigen::Index at =
        joint_covariance.rows() - kCornerParameters + 2 * static_cast<Eigen::Index>(c);
    // Variance of the fitted displacement: what the prior allows less what is still unknown.
    const Eigen::Matrix2d fitted =
        variance * Eigen::Matrix2d::Identity() - joint_covariance.block<2, 2>(at, at);
    const double least = kLeastKnowledge * variance;
    if (!(fitted.determinant() > least * least) || !(fitted.trace() > 0.0))
      continue;
    const Eigen::Vector2d weighed = fitted.inverse() * offset;
    SuspectCorner suspect;
    suspect.corner = c;
    suspect.distance = variance * weighed.norm();
    suspect.chi_squared = offset.dot(weighed);
    suspects.push_back(suspect);
  }
  if (suspects.empty())
    return std::nullopt;
  std::sort(suspects.begin(), suspects.end(), [](const SuspectCorner& a, const SuspectCorner& b) {
    return a.chi_squared > b.chi_squared;
  });
  SuspectCorner worst = suspects[0];
  worst.lead = worst.chi_squared;
  if (suspects.size() > 1) {
    worst.runner_up = suspects[1].corner;
    worst.lead -= suspects[1].chi_squared;
  }
  return worst;
}

bool isDisplaced(const SuspectCorner& suspect) {
  return suspect.chi_squared > kDisplaced;
}

}  // namespace wiimote_tracker::square
