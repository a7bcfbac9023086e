// A solver of its own: the same problem with the functors of src/adjust and Ceres' sparse Cholesky
// solver gave the same cameras, but took 5.5 times the processor time (2.0 s instead of 0.36 s for
// four cameras and 25 s). Here the path's normal equations are a band, bordered by the cameras.
#include "adjustment.h"

#include "lens_prior.h"

#include "wave/error.h"

#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::wave {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// How far a spline may bend a stick [m]: far less than any camera can tell.
constexpr double kStickStddev = 0.0002;
constexpr int kMaximumIterations = 60;
// Ends when a step makes less of a difference than this to the sum of squares.
constexpr double kRelativeDecrease = 1e-9;

/// Second derivative of a path at a knot, as a share of the accelerations to expect.
Eigen::VectorXd bend(const Trajectory& trajectory, Eigen::Index control, double weight) {
  const Eigen::MatrixXd& c = trajectory.controls();
  return weight * (c.col(control) - 2.0 * c.col(control + 1) + c.col(control + 2));
}

/// Place of a knot; its fourth weight is 0.
Trajectory::Place knot(const Trajectory& trajectory, Eigen::Index interval) {
  return *trajectory.at(trajectory.timeOf(interval) + 1e-9 * trajectory.spacing());
}

}  // namespace

Adjustment::Adjustment(const Recording& recording,
                       const WaveOptions& options,
                       std::vector<Eigen::Vector3d> nominal_corners,
                       Gauge gauge)
    : recording_(recording),
      options_(options),
      nominal_corners_(std::move(nominal_corners)),
      gauge_(gauge) {}

void Adjustment::use(std::vector<Match> matches, double loss_scale) {
  matches_ = std::move(matches);
  loss_scale_ = loss_scale;
}

Eigen::Index Adjustment::cornerColumn() const {
  return kCameraSize * static_cast<Eigen::Index>(recording_.cameras.size());
}

Eigen::Index Adjustment::wandColumn() const {
  return cornerColumn() + 2 * static_cast<Eigen::Index>(nominal_corners_.size());
}

int Adjustment::solve(State* state, const std::function<bool()>& keep_going) {
  seen_.assign(static_cast<std::size_t>(state->trajectory.intervals()), false);
  for (const Match& match : matches_) {
    if (const auto place = state->trajectory.at(match.stamp + state->offsets[match.camera]))
      seen_[static_cast<std::size_t>(place->first)] = true;
  }
  double now = cost(*state);
  if (!std::isfinite(now))
    throw WaveError(
        "the wave cannot be seen from where the cameras seem to stand: check that nobody moved a "
        "camera, and record again");
  double damping = 1e-4;
  int iteration = 0;
  bool stale = true;
  Eigen::VectorXd border;
  Eigen::VectorXd path;
  while (iteration < kMaximumIterations) {
    if (!keep_going())
      throw Cancelled("the calibration was cancelled: nothing was changed");
    if (stale)
      linearize(*state);
    stale = false;
    ++iteration;
    double next = kInfinity;
    State candidate;
    if (step(damping, &border, &path)) {
      candidate = moved(*state, border, path);
      next = cost(candidate);
    }
    if (next <= now) {
      const bool settled = now - next <= kRelativeDecrease * now;
      *state = std::move(candidate);
      now = next;
      damping = std::max(1e-10, 0.1 * damping);
      stale = true;
      if (settled)
        break;
    } else {
      damping *= 10.0;
      // Nothing is better than here, to the last bit.
      if (damping > 1e8)
        break;
    }
  }
  return iteration;
}

double Adjustment::cost(const State& state) const {
  double sum = 0.0;
  const double c2 = loss_scale_ * loss_scale_;
  for (const Match& match : matches_) {
    const auto place = state.trajectory.at(match.stamp + state.offsets[match.camera]);
    if (!place)
      return kInfinity;
    const geometry::Camera& camera = state.cameras[match.camera];
    const Eigen::Vector3d in_camera =
        camera.world_from_camera.linear().transpose() *
        (state.trajectory.position(*place, match.led) - camera.center());
    if (!(in_camera.z() > 1e-6))
      return kInfinity;
    const Eigen::Vector2d pixel =
        camera.intrinsics.pixelFromNormalized(in_camera.head<2>() / in_camera.z());
    const double squared = (match.whitening * (pixel - match.pixel)).squaredNorm();
    sum += std::isfinite(c2) ? c2 * std::log1p(squared / c2) : squared;
  }

  const double spacing = state.trajectory.spacing();
  const double weight = 1.0 / (spacing * spacing * options_.acceleration);
  for (Eigen::Index k = 0; k + 2 < state.trajectory.controls().cols(); ++k)
    sum += bend(state.trajectory, k, weight).squaredNorm();
  if (recording_.wand) {
    for (Eigen::Index i = 0; i < state.trajectory.intervals(); ++i) {
      if (!seen_[static_cast<std::size_t>(i)])
        continue;
      const Trajectory::Place place = knot(state.trajectory, i);
      const double length =
          (state.trajectory.position(place, 1) - state.trajectory.position(place, 0)).norm();
      sum += std::pow((length - state.wand_length) / kStickStddev, 2);
    }
    sum += std::pow((state.wand_length - recording_.wand->length) / recording_.wand->stddev, 2);
  }

  const square::Uncertainty& uncertainty = options_.uncertainty;
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    const geometry::Camera& camera = state.cameras[i];
    if (!(camera.intrinsics.fx > 0.0) || !(camera.intrinsics.fy > 0.0))
      return kInfinity;
    const square::CameraSightings& sightings = recording_.cameras[i].sightings;
    sum += lensResidual(camera.intrinsics, sightings.intrinsics, uncertainty).squaredNorm();
    sum += std::pow(state.offsets[i] / options_.offset, 2);
    for (std::size_t c = 0; c < nominal_corners_.size(); ++c) {
      if (!sightings.corners[c])
        continue;
      Projection projection;
      if (!project(camera, state.corners[c], &projection))
        return kInfinity;
      sum += (projection.pixel - *sightings.corners[c]).squaredNorm() /
             (uncertainty.pixel * uncertainty.pixel);
    }
  }
  for (std::size_t c = 0; c < nominal_corners_.size(); ++c)
    sum += (state.corners[c] - nominal_corners_[c]).squaredNorm() /
           (uncertainty.placement * uncertainty.placement);
  return std::isfinite(sum) ? 0.5 * sum : kInfinity;
}

void Adjustment::linearize(const State& state) {
  const Eigen::Index unknowns = state.trajectory.controls().size();
  const Eigen::Index block = 3 * state.trajectory.leds();
  const Eigen::Index borders = wandColumn() + (recording_.wand ? 1 : 0);
  if (!band_ || band_->size() != unknowns || coupling_.cols() != borders) {
    band_.emplace(unknowns, 4 * block - 1);
    coupling_.resize(unknowns, borders);
    border_.resize(borders, borders);
  }
  band_->setZero();
  coupling_.setZero();
  border_.setZero();
  path_gradient_ = Eigen::VectorXd::Zero(unknowns);
  border_gradient_ = Eigen::VectorXd::Zero(borders);
  addMatches(state);
  addPaths(state);
  addCorners(state);
  addLenses(state);
  holdGauge();
}

void Adjustment::addMatches(const State& state) {
  const Eigen::Index block = 3 * state.trajectory.leds();
  const double c2 = loss_scale_ * loss_scale_;
  Projection projection;
  for (const Match& match : matches_) {
    const auto place = state.trajectory.at(match.stamp + state.offsets[match.camera]);
    if (!place || !project(state.cameras[match.camera],
                           state.trajectory.position(*place, match.led), &projection))
      continue;
    projection.by_camera.col(kOffset) =
        projection.by_point * state.trajectory.velocity(*place, match.led);
    const Eigen::Vector2d residual = match.whitening * (projection.pixel - match.pixel);
    const double weight = 1.0 / (1.0 + residual.squaredNorm() / c2);
    const PointJacobian by_point = match.whitening * projection.by_point;
    const CameraJacobian by_camera = match.whitening * projection.by_camera;

    const Eigen::Index column = kCameraSize * static_cast<Eigen::Index>(match.camera);
    border_.block<kCameraSize, kCameraSize>(column, column).noalias() +=
        weight * by_camera.transpose() * by_camera;
    border_gradient_.segment<kCameraSize>(column).noalias() +=
        weight * by_camera.transpose() * residual;
    const Eigen::Matrix3d point_point = weight * by_point.transpose() * by_point;
    const Eigen::Matrix<double, 3, kCameraSize> point_camera =
        weight * by_point.transpose() * by_camera;
    const Eigen::Vector3d gradient = weight * by_point.transpose() * residual;
    for (Eigen::Index k = 0; k < 4; ++k) {
      const Eigen::Index row = block * (place->first + k) + 3 * match.led;
      path_gradient_.segment<3>(row) += place->value(k) * gradient;
      coupling_.block<3, kCameraSize>(row, column) += place->value(k) * point_camera;
      for (Eigen::Index l = 0; l <= k; ++l) {
        const Eigen::Index other = block * (place->first + l) + 3 * match.led;
        const double product = place->value(k) * place->value(l);
        for (Eigen::Index b = 0; b < 3; ++b) {
          for (Eigen::Index a = k == l ? b : 0; a < 3; ++a)
            (*band_)(row + a, other + b) += product * point_point(a, b);
        }
      }
    }
  }
}

void Adjustment::addPaths(const State& state) {
  const Trajectory& trajectory = state.trajectory;
  const Eigen::Index block = 3 * trajectory.leds();
  const double weight = 1.0 / (trajectory.spacing() * trajectory.spacing() * options_.acceleration);
  const double factors[] = {weight, -2.0 * weight, weight};
  for (Eigen::Index control = 0; control + 2 < trajectory.controls().cols(); ++control) {
    const Eigen::VectorXd residual = bend(trajectory, control, weight);
    for (Eigen::Index k = 0; k < 3; ++k) {
      path_gradient_.segment(block * (control + k), block) += factors[k] * residual;
      for (Eigen::Index l = 0; l <= k; ++l) {
        for (Eigen::Index a = 0; a < block; ++a)
          (*band_)(block * (control + k) + a, block * (control + l) + a) += factors[k] * factors[l];
      }
    }
  }
  if (!recording_.wand)
    return;
  const Eigen::Index wand = wandColumn();
  for (Eigen::Index i = 0; i < trajectory.intervals(); ++i) {
    if (!seen_[static_cast<std::size_t>(i)])
      continue;
    const Trajectory::Place place = knot(trajectory, i);
    const Eigen::Vector3d stick = trajectory.position(place, 1) - trajectory.position(place, 0);
    const double length = stick.norm();
    const double residual = (length - state.wand_length) / kStickStddev;
    const Eigen::Vector3d direction = stick / (length * kStickStddev);
    Eigen::Matrix<double, 6, 1> ends;
    ends << -direction, direction;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Matrix<double, 6, 1> row = place.value(k) * ends;
      const Eigen::Index at = block * (place.first + k);
      path_gradient_.segment<6>(at) += row * residual;
      coupling_.col(wand).segment<6>(at) -= row / kStickStddev;
      for (Eigen::Index l = 0; l <= k; ++l) {
        for (Eigen::Index b = 0; b < 6; ++b) {
          for (Eigen::Index a = k == l ? b : 0; a < 6; ++a)
            (*band_)(at + a, block * (place.first + l) + b) += row(a) * place.value(l) * ends(b);
        }
      }
    }
    border_(wand, wand) += 1.0 / (kStickStddev * kStickStddev);
    border_gradient_(wand) -= residual / kStickStddev;
  }
  const double stddev = recording_.wand->stddev;
  border_(wand, wand) += 1.0 / (stddev * stddev);
  border_gradient_(wand) += (state.wand_length - recording_.wand->length) / (stddev * stddev);
}

void Adjustment::addCorners(const State& state) {
  const square::Uncertainty& uncertainty = options_.uncertainty;
  const double information = 1.0 / (uncertainty.pixel * uncertainty.pixel);
  for (std::size_t c = 0; c < nominal_corners_.size(); ++c) {
    const Eigen::Index row = cornerColumn() + 2 * static_cast<Eigen::Index>(c);
    const double placement = 1.0 / (uncertainty.placement * uncertainty.placement);
    border_.block<2, 2>(row, row) += placement * Eigen::Matrix2d::Identity();
    border_gradient_.segment<2>(row) +=
        placement * (state.corners[c] - nominal_corners_[c]).head<2>();
    for (std::size_t i = 0; i < state.cameras.size(); ++i) {
      const auto& pixel = recording_.cameras[i].sightings.corners[c];
      Projection projection;
      if (!pixel || !project(state.cameras[i], state.corners[c], &projection))
        continue;
      const Eigen::Vector2d residual = projection.pixel - *pixel;
      const Eigen::Matrix2d by_corner = projection.by_point.leftCols<2>();
      const Eigen::Index column = kCameraSize * static_cast<Eigen::Index>(i);
      border_.block<kCameraSize, kCameraSize>(column, column) +=
          information * projection.by_camera.transpose() * projection.by_camera;
      border_.block<2, kCameraSize>(row, column) +=
          information * by_corner.transpose() * projection.by_camera;
      border_.block<2, 2>(row, row) += information * by_corner.transpose() * by_corner;
      border_gradient_.segment<kCameraSize>(column) +=
          information * projection.by_camera.transpose() * residual;
      border_gradient_.segment<2>(row) += information * by_corner.transpose() * residual;
    }
  }
}

void Adjustment::addLenses(const State& state) {
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    const geometry::Intrinsics& lens = state.cameras[i].intrinsics;
    const auto residual =
        lensResidual(lens, recording_.cameras[i].sightings.intrinsics, options_.uncertainty);
    const auto jacobian = lensJacobian(lens, options_.uncertainty);
    const Eigen::Index column = kCameraSize * static_cast<Eigen::Index>(i);
    border_.block<5, 5>(column + 6, column + 6) += jacobian.transpose() * jacobian;
    border_gradient_.segment<5>(column + 6) += jacobian.transpose() * residual;
    const double information = 1.0 / (options_.offset * options_.offset);
    border_(column + kOffset, column + kOffset) += information;
    border_gradient_(column + kOffset) += information * state.offsets[i];
  }
}

/// All clocks could be shifted together with the path, and without square all cameras moved.
void Adjustment::holdGauge() {
  const auto hold = [this](Eigen::Index column) {
    border_.row(column).setZero();
    border_.col(column).setZero();
    border_(column, column) = 1.0;
    border_gradient_(column) = 0.0;
    coupling_.col(column).setZero();
  };
  hold(kOffset);
  for (Eigen::Index column = 0; gauge_ == Gauge::kFirstCamera && column < 6; ++column)
    hold(column);
}

bool Adjustment::step(double damping, Eigen::VectorXd* border, Eigen::VectorXd* path) const {
  BandMatrix factor = *band_;
  factor.scaleDiagonal(1.0 + damping);
  if (!factor.factorize())
    return false;
  // The path is eliminated: L L^T = band, and what is left over is a small dense problem.
  RowMajorMatrix right(coupling_.rows(), coupling_.cols() + 1);
  right << coupling_, path_gradient_;
  factor.solveLower(&right);
  const auto coupled = right.leftCols(coupling_.cols());
  const auto gradient = right.col(coupling_.cols());
  Eigen::MatrixXd reduced = border_;
  reduced.diagonal() *= 1.0 + damping;
  reduced.selfadjointView<Eigen::Lower>().rankUpdate(coupled.transpose(), -1.0);
  // Parameters of very different units: scaled to a unit diagonal.
  const Eigen::VectorXd scale = reduced.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite())
    return false;
  reduced = scale.asDiagonal() * reduced * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> solver(reduced);
  if (solver.info() != Eigen::Success)
    return false;
  const Eigen::VectorXd slope = border_gradient_ - coupled.transpose() * gradient;
  *border = -scale.cwiseProduct(solver.solve(scale.cwiseProduct(slope)));
  *path = -gradient - coupled * *border;
  factor.solveUpper(path);
  return border->allFinite() && path->allFinite();
}

State Adjustment::moved(const State& state,
                        const Eigen::VectorXd& border,
                        const Eigen::VectorXd& path) const {
  State result = state;
  Eigen::MatrixXd& controls = result.trajectory.controls();
  controls += Eigen::Map<const Eigen::MatrixXd>(path.data(), controls.rows(), controls.cols());
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    const auto change = border.segment<kCameraSize>(kCameraSize * static_cast<Eigen::Index>(i));
    geometry::Camera& camera = result.cameras[i];
    const Eigen::Matrix3d turned =
        geometry::so3::exp(change.head<3>()) * state.cameras[i].world_from_camera.linear();
    camera.world_from_camera.linear() = Eigen::Quaterniond(turned).normalized().toRotationMatrix();
    camera.world_from_camera.translation() += change.segment<3>(3);
    geometry::Intrinsics& lens = camera.intrinsics;
    lens.fx += change(6);
    lens.fy += change(7);
    lens.cx += change(8);
    lens.cy += change(9);
    lens.distortion[0] += change(10);
    result.offsets[i] += change(kOffset);
  }
  for (std::size_t c = 0; c < nominal_corners_.size(); ++c)
    result.corners[c].head<2>() +=
        border.segment<2>(cornerColumn() + 2 * static_cast<Eigen::Index>(c));
  if (recording_.wand)
    result.wand_length += border(wandColumn());
  return result;
}

Eigen::MatrixXd Adjustment::covariance(const State& state) {
  linearize(state);
  BandMatrix factor = *band_;
  const char* const kSingular =
      "the recording does not determine the cameras: wave longer, through more of the volume";
  if (!factor.factorize())
    throw WaveError(kSingular);
  RowMajorMatrix coupled = coupling_;
  factor.solveLower(&coupled);
  Eigen::MatrixXd reduced = border_;
  reduced.selfadjointView<Eigen::Lower>().rankUpdate(coupled.transpose(), -1.0);
  const Eigen::VectorXd scale = reduced.diagonal().cwiseSqrt().cwiseInverse();
  reduced = scale.asDiagonal() * reduced * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> solver(reduced);
  if (!scale.allFinite() || solver.info() != Eigen::Success)
    throw WaveError(kSingular);
  const Eigen::MatrixXd inverse =
      solver.solve(Eigen::MatrixXd::Identity(reduced.rows(), reduced.cols()));
  Eigen::MatrixXd result =
      (scale.asDiagonal() * inverse * scale.asDiagonal()).topLeftCorner(wandColumn(), wandColumn());
  const auto release = [&result](Eigen::Index column) {
    result.row(column).setZero();
    result.col(column).setZero();
  };
  release(kOffset);
  for (Eigen::Index column = 0; gauge_ == Gauge::kFirstCamera && column < 6; ++column)
    release(column);
  return 0.5 * (result + result.transpose());
}

double Adjustment::misfit(const State& state) const {
  double sum = 0.0;
  double freedom = 0.0;
  std::vector<bool> fitted(static_cast<std::size_t>(state.trajectory.controls().cols()), false);
  for (const Match& match : matches_) {
    const auto place = state.trajectory.at(match.stamp + state.offsets[match.camera]);
    Projection projection;
    if (!place || !project(state.cameras[match.camera],
                           state.trajectory.position(*place, match.led), &projection))
      continue;
    sum += (match.whitening * (projection.pixel - match.pixel)).squaredNorm();
    freedom += 2.0;
    for (Eigen::Index k = 0; k < 4; ++k)
      fitted[static_cast<std::size_t>(place->first + k)] = true;
  }
  freedom -= 3.0 * static_cast<double>(state.trajectory.leds()) *
             static_cast<double>(std::count(fitted.begin(), fitted.end(), true));
  freedom -= static_cast<double>(cornerColumn());
  if (recording_.wand)
    freedom += static_cast<double>(std::count(seen_.begin(), seen_.end(), true));
  return std::sqrt(sum / std::max(1.0, freedom));
}

}  // namespace wiimote_tracker::wave
