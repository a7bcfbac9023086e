#include "rooms/passage_fit.h"

#include "adjust/chi_squared.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wiimote_tracker::rooms {

namespace {

// Degrees of freedom of the prior of each axis' squared scatter, a scaled inverse chi-squared
// distribution about the model's.
constexpr double kModelWeight = 4.0;
// Nobody walks that many times less straight than the model.
constexpr double kMostScatter = 3.0;
constexpr int kReweightings = 5;

/// How far both rigs put a place apart, over the standard deviations of the model, along the axes
/// in the first.
Eigen::Vector3d misfitOf(const Shared& place, const Eigen::Isometry3d& motion) {
  return (place.in_first.linear().transpose() *
          (motion * place.in_second.translation() - place.in_first.translation()))
      .cwiseQuotient(place.stddevs);
}

}  // namespace

Eigen::Isometry3d PassageProblem::start() const {
  std::vector<Eigen::Vector3d> in_first;
  std::vector<Eigen::Vector3d> in_second;
  for (const auto& passage : passages_) {
    for (const Shared& place : passage) {
      in_first.emplace_back(place.in_first.translation());
      in_second.emplace_back(place.in_second.translation());
      if (!vertical_)
        continue;
      // A point above the place tells the tilt.
      in_first.emplace_back(place.in_first.translation() + vertical_->in_first.linear().col(2));
      in_second.emplace_back(place.in_second.translation() + vertical_->in_second.linear().col(2));
    }
  }
  const Eigen::Vector3d spread = geometry::spreadOf(in_second);
  if (!(spread[1] > kThinnest * spread[0]))
    throw Error(
        "all passages are on one line, which leaves the tilt of one room against the other "
        "open: walk through the door in other directions, too");
  return geometry::rigidAlignment(in_first, in_second);
}

RigMotion PassageProblem::fit(const PassageIndices& used,
                              const Eigen::Isometry3d& start,
                              const std::vector<Scatter>& scatters) const {
  std::vector<Shared> shared;
  for (const std::size_t i : used) {
    for (Shared place : passages_[i]) {
      place.stddevs = place.stddevs.cwiseProduct(scatters[i]);
      shared.push_back(place);
    }
  }
  if (vertical_)
    shared.push_back(*vertical_);
  return fitMotion(first_, second_, shared, start);
}

std::vector<double> PassageProblem::misfits(const Eigen::Isometry3d& motion) const {
  std::vector<double> result;
  for (const SharedPlaces& passage : passages_) {
    double sum = 0.0;
    for (const Shared& place : passage)
      sum += misfitOf(place, motion).squaredNorm();
    result.push_back(sum / kConditions);
  }
  return result;
}

Scatter PassageProblem::scatter(const PassageIndices& used, const RigMotion& motion) const {
  const Eigen::Index count =
      motion.by_errors.cols() - first_.covariance.cols() - second_.covariance.cols();
  const Eigen::Matrix<double, 6, Eigen::Dynamic> gain = motion.by_errors.rightCols(count);
  Eigen::Array3d squared = Eigen::Array3d::Constant(kModelWeight);
  Eigen::Array3d conditions = Eigen::Array3d::Constant(kModelWeight);
  Eigen::Index row = 0;
  for (const std::size_t i : used) {
    for (const Shared& place : passages_[i]) {
      squared += misfitOf(place, motion.first_from_second).array().square();
      // The motion follows an error in part: its redundancy number (Foerstner 1979) is left.
      Eigen::Matrix<double, 3, 6> by_motion;
      by_motion << -geometry::so3::skew(motion.first_from_second.linear() *
                                        place.in_second.translation()),
          Eigen::Matrix3d::Identity();
      const auto axes = place.in_first.linear();
      conditions +=
          1.0 + (axes.transpose() * by_motion * gain.middleCols<3>(row) * axes).diagonal().array();
      row += 3;
    }
  }
  return (squared / conditions).sqrt();
}

namespace {

/// Whether the passage that `others` does without contradicts them: the F test of its misfit
/// against their scatter, with which both were fitted, at 99.9 % (E. Paulson, "An approximate
/// normalization of the analysis of variance distribution", Ann. Math. Statist. 13(2), 1942).
bool contradicts(const RigMotion& all, const RigMotion& others) {
  const double ratio = std::max(0.0, all.chi_squared - others.chi_squared) / kConditions;
  const double a = 2.0 / 9.0 / kConditions;
  const double b = 2.0 / 9.0 / (3.0 * kModelWeight + others.degrees_of_freedom);
  const double root = std::cbrt(ratio);
  return ((1.0 - b) * root - (1.0 - a)) / std::sqrt(b * root * root + a) > adjust::kThreeNines;
}

/// All passages, those that fit best first: beside a motion that few wrong ones hardly change
/// (reweighted least squares with the weights of a Cauchy distribution).
PassageIndices bestFirst(const PassageProblem& problem) {
  PassageIndices order(problem.size());
  std::iota(order.begin(), order.end(), 0);
  Eigen::Isometry3d motion = problem.start();
  std::vector<double> misfits = problem.misfits(motion);
  for (int i = 0; i < kReweightings; ++i) {
    std::vector<Scatter> scatters;
    scatters.reserve(misfits.size());
    for (const double misfit : misfits)
      scatters.push_back(Scatter::Constant(std::sqrt(1.0 + misfit)));
    motion = problem.fit(order, motion, scatters).first_from_second;
    misfits = problem.misfits(motion);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return misfits[a] < misfits[b]; });
  return order;
}

/// Fits passages with the scatter that they show: with it, the weights of rigs and slope against
/// those of the passages change.
PassageFit fitScattered(const PassageProblem& problem,
                        const PassageIndices& used,
                        const Eigen::Isometry3d& start) {
  PassageFit fit{problem.fit(used, start, Scatter::Ones()), Scatter::Ones(), used};
  for (int i = 0; i < kReweightings; ++i) {
    fit.scatter = problem.scatter(used, fit.motion);
    fit.motion = problem.fit(used, fit.motion.first_from_second, fit.scatter);
  }
  return fit;
}

}  // namespace

PassageFit fitPassages(const PassageProblem& problem) {
  const std::size_t count = problem.size();
  const PassageIndices order = bestFirst(problem);
  // Two thirds of the passages, and the others as long as they do not contradict these.
  PassageIndices used(order.begin(),
                      order.begin() + static_cast<std::ptrdiff_t>((2 * count + 2) / 3));
  PassageFit fit = fitScattered(problem, used, problem.start());
  while (used.size() < count) {
    used.push_back(order[used.size()]);
    const Eigen::Isometry3d& start = fit.motion.first_from_second;
    if (contradicts(problem.fit(used, start, fit.scatter), fit.motion))
      break;
    fit = fitScattered(problem, used, start);
  }
  const double most = fit.scatter.maxCoeff();
  if (most > kMostScatter)
    throw Error("the passages contradict one another, " + format("%.1f", most) +
                " times as much as those of somebody who walks straight: carry one LED alone, "
                "straight and steadily, and record again");
  return fit;
}

}  // namespace wiimote_tracker::rooms
