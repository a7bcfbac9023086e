#include "steps.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace wiimote_tracker::bundle {

namespace {

// fx, cx, cy and k1 of a lens.
constexpr Eigen::Index kCompared[] = {0, 2, 3, 4};
// A part whose variance is hardly larger than that of all observations tells nothing.
constexpr double kLeastGain = 0.1;
// Cameras that are left out, one at a time.
constexpr std::size_t kMostLeftOut = 6;

/// Leaves out points that only one camera still sees: they tell nothing.
void dropSingleViews(Reconstruction* part) {
  std::vector<int> views(part->points.size(), 0);
  for (std::size_t i = 0; i < part->observations.size(); ++i)
    views[part->observations[i].point] += part->inliers[i] ? 1 : 0;
  for (std::size_t i = 0; i < part->observations.size(); ++i)
    part->inliers[i] = part->inliers[i] && views[part->observations[i].point] >= 2;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i] < 2)
      part->points[i].reset();
  }
}

/// The observations of all cameras but one, or of some of the points.
Reconstruction part(const Reconstruction& all,
                    std::size_t left_out,
                    const std::function<bool(std::size_t)>& has_point) {
  Reconstruction result;
  result.points = all.points;
  for (std::size_t i = 0; i < all.cameras.size(); ++i) {
    if (i != left_out)
      result.cameras.push_back(all.cameras[i]);
  }
  for (std::size_t i = 0; i < all.observations.size(); ++i) {
    Observation observation = all.observations[i];
    if (observation.camera == left_out || !has_point(observation.point))
      continue;
    observation.camera -= observation.camera > left_out ? 1 : 0;
    result.observations.push_back(observation);
    result.inliers.push_back(all.inliers[i]);
  }
  dropSingleViews(&result);
  return result;
}

/// The points' coordinates along their principal axes; NaN where a point is not determined.
Eigen::Matrix3Xd alongPrincipalAxes(const Reconstruction& all) {
  Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Constant(
      3, static_cast<Eigen::Index>(all.points.size()), std::numeric_limits<double>::quiet_NaN());
  std::vector<Eigen::Vector3d> known;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    if (!all.points[i])
      continue;
    points.col(static_cast<Eigen::Index>(i)) = *all.points[i];
    known.push_back(*all.points[i]);
  }
  Eigen::Matrix3Xd centred = Eigen::Map<const Eigen::Matrix3Xd>(
      known.data()->data(), 3, static_cast<Eigen::Index>(known.size()));
  const Eigen::Vector3d mean = centred.rowwise().mean();
  centred.colwise() -= mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred * centred.transpose());
  return axes.eigenvectors().transpose() * (points.colwise() - mean);
}

/// Mean square of the normalised moves of the lenses.
class Moves {
 public:
  Moves(const Reconstruction& all, const Options& options)
      : options_(options), all_(all, options) {}

  /// The difference of a part's estimate and that of all has the difference of their covariances
  /// (Hausman 1978: the estimate from all is efficient).
  void add(const Reconstruction& part, std::size_t left_out) {
    if (std::find(part.inliers.begin(), part.inliers.end(), true) == part.inliers.end())
      return;
    const Certainty certainty(part, options_);
    for (std::size_t i = 0; i < part.cameras.size(); ++i) {
      const auto own = certainty.lensCovariance(i);
      const auto whole = all_.lensCovariance(i < left_out ? i : i + 1);
      if (!own || !whole)
        return;
      const Eigen::VectorXd step = certainty.lensStep(i);
      for (const Eigen::Index k : kCompared) {
        const double variance = (*own)(k, k) - (*whole)(k, k);
        if (variance < kLeastGain * (*own)(k, k))
          continue;
        sum_ += step[k] * step[k] / variance;
        count_ += 1.0;
      }
    }
  }

  double mean() const { return count_ > 0.0 ? sum_ / count_ : 1.0; }

 private:
  const Options& options_;
  const Certainty all_;
  double sum_ = 0.0;
  double count_ = 0.0;
};

}  // namespace

double birgeRatio(const Reconstruction& adjusted, const Options& options) {
  const std::size_t cameras = adjusted.cameras.size();
  Moves moves(adjusted, options);
  const auto addHalves = [&](const std::function<bool(std::size_t)>& in_first) {
    moves.add(part(adjusted, cameras, in_first), cameras);
    moves.add(part(adjusted, cameras, [&](std::size_t i) { return !in_first(i); }), cameras);
  };
  addHalves([&](std::size_t point) { return 2 * point < adjusted.points.size(); });
  const Eigen::Matrix3Xd points = alongPrincipalAxes(adjusted);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    addHalves([&](std::size_t i) { return points(axis, static_cast<Eigen::Index>(i)) < 0.0; });
  const std::size_t stride = (cameras + kMostLeftOut - 1) / kMostLeftOut;
  for (std::size_t i = 0; i < cameras && cameras > 2; i += stride)
    moves.add(part(adjusted, i, [](std::size_t) { return true; }), i);
  return std::sqrt(std::max(1.0, moves.mean()));
}

}  // namespace wiimote_tracker::bundle
