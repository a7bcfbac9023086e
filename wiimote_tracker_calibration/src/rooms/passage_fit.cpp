#include "rooms/passage_fit.h"

#include "place/chi_squared.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace wiimote_tracker::rooms {

namespace {

using session::RigMotion;
using session::Shared;

// The size of the model's deviations counts as if that many conditions had shown it.
constexpr double kModelWeight = 4.0;
// Nobody walks that many times less straight than the model.
constexpr double kMostScatter = 3.0;
// Minimum width of the places relative to their length: on a line the rotation is not determined.
constexpr double kThinnest = 0.05;
constexpr int kReweightings = 5;

}  // namespace

Eigen::Isometry3d PassageProblem::start() const {
  const auto count = static_cast<Eigen::Index>(passages_.size());
  const Eigen::Index each = vertical_ ? 4 : 2;
  Eigen::Matrix3Xd to(3, each * count);
  Eigen::Matrix3Xd from(3, each * count);
  for (Eigen::Index i = 0; i < to.cols(); ++i) {
    const Shared& place =
        passages_[static_cast<std::size_t>(i / each)][static_cast<std::size_t>(i % 2)];
    to.col(i) = place.in_first.translation();
    from.col(i) = place.in_second.translation();
    if (i % each >= 2) {  // above the places
      to.col(i) += vertical_->in_first.linear().col(2);
      from.col(i) += vertical_->in_second.linear().col(2);
    }
  }
  const Eigen::Matrix3Xd centered = from.colwise() - from.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(centered * centered.transpose());
  if (!(spread.eigenvalues()[1] > kThinnest * kThinnest * spread.eigenvalues()[2]))
    throw Error(
        "all passages are on one line, which leaves the tilt of one room against the other "
        "open: walk through the door in other directions, too");
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

RigMotion PassageProblem::fit(const PassageIndices& used,
                              const Eigen::Isometry3d& start,
                              const std::vector<double>& scatters) const {
  std::vector<Shared> shared;
  for (const std::size_t i : used) {
    for (Shared place : passages_[i]) {
      place.stddev *= scatters[i];
      shared.push_back(place);
    }
  }
  if (vertical_)
    shared.push_back(*vertical_);
  return session::fitMotion(first_, second_, shared, start);
}

std::vector<double> PassageProblem::misfits(const Eigen::Isometry3d& motion) const {
  std::vector<double> result;
  for (const SharedPlaces& passage : passages_) {
    double sum = 0.0;
    for (const Shared& place : passage)
      sum += (motion * place.in_second.translation() - place.in_first.translation()).squaredNorm() /
             (place.stddev * place.stddev);
    result.push_back(sum / kConditions);
  }
  return result;
}

namespace {

/// Estimated variance of the passages' errors over that of the model.
/// @param scatter of the passages that the motion was fitted with
double varianceRatio(const RigMotion& motion, double scatter = 1.0) {
  return (kModelWeight + scatter * scatter * motion.chi_squared) /
         (kModelWeight + motion.degrees_of_freedom);
}

/// Whether the passage that `others` does without contradicts them: the F test of its misfit
/// against their scatter at 99.9 % (E. Paulson, "An approximate normalization of the analysis of
/// variance distribution", Ann. Math. Statist. 13(2), 1942).
bool contradicts(const RigMotion& all, const RigMotion& others) {
  const double ratio =
      std::max(0.0, all.chi_squared - others.chi_squared) / kConditions / varianceRatio(others);
  const double a = 2.0 / 9.0 / kConditions;
  const double b = 2.0 / 9.0 / (kModelWeight + others.degrees_of_freedom);
  const double root = std::cbrt(ratio);
  return ((1.0 - b) * root - (1.0 - a)) / std::sqrt(b * root * root + a) > place::kThreeNines;
}

/// All passages, those that fit best first: beside a motion that few wrong ones hardly change
/// (reweighted least squares with the weights of a Cauchy distribution).
PassageIndices bestFirst(const PassageProblem& problem) {
  PassageIndices order(problem.size());
  std::iota(order.begin(), order.end(), 0);
  Eigen::Isometry3d motion = problem.start();
  std::vector<double> misfits = problem.misfits(motion);
  for (int i = 0; i < kReweightings; ++i) {
    std::vector<double> scatters;
    for (const double misfit : misfits)
      scatters.push_back(std::sqrt(1.0 + misfit));
    motion = problem.fit(order, motion, scatters).first_from_second;
    misfits = problem.misfits(motion);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return misfits[a] < misfits[b]; });
  return order;
}

/// Two thirds of the passages, and the others as long as they do not contradict these.
PassageFit fitAgreeing(const PassageProblem& problem) {
  const std::size_t count = problem.size();
  const PassageIndices order = bestFirst(problem);
  PassageFit fit;
  fit.used.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>((2 * count + 2) / 3));
  fit.motion = problem.fit(fit.used, problem.start(), 1.0);
  while (fit.used.size() < count) {
    PassageIndices more = fit.used;
    more.push_back(order[more.size()]);
    const RigMotion motion = problem.fit(more, fit.motion.first_from_second, 1.0);
    if (contradicts(motion, fit.motion))
      break;
    fit.used = more;
    fit.motion = motion;
  }
  fit.scatter = std::sqrt(varianceRatio(fit.motion));
  if (fit.scatter > kMostScatter)
    throw Error("the passages contradict one another, " + format("%.1f", fit.scatter) +
                " times as much as those of somebody who walks straight: carry one LED alone, "
                "straight and steadily, and record again");
  return fit;
}

}  // namespace

PassageFit fitPassages(const PassageProblem& problem) {
  PassageFit result = fitAgreeing(problem);
  // With the scatter, the weights of rigs and slope against those of the passages change.
  for (int i = 0; i < kReweightings; ++i) {
    result.motion = problem.fit(result.used, result.motion.first_from_second, result.scatter);
    result.scatter = std::sqrt(varianceRatio(result.motion, result.scatter));
  }
  return result;
}

}  // namespace wiimote_tracker::rooms
