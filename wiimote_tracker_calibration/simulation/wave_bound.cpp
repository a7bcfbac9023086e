#include "wiimote_tracker_calibration/simulation/wave_bound.h"

#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::wave {

namespace {

// As WaveBound::covariance: the parameters of a rig's covariance that a wave estimates, in its
// order but for the time offset.
constexpr Eigen::Index kPerCamera = 12;
constexpr Eigen::Index kPose = 6;
constexpr Eigen::Index kFx = 6, kFy = 7, kCx = 8, kCy = 9, kK1 = 10;
constexpr Eigen::Index kWaveTimeOffset = 11;
// Standard deviations: of a parameter that is given, of a clock's offset [s], of a control point
// [m], and of the wand's length while it moves [m] (as in adjustment.cpp).
constexpr double kGiven = 1e-9;
constexpr double kClockStddev = 0.05;
constexpr double kAnywhere = 10.0;
constexpr double kStick = 0.0002;

/// B-spline of a degree on whole-numbered knots, by Cox and de Boor's recursion.
double basis(int degree, double knot, double t) {
  if (degree == 0)
    return t >= knot && t < knot + 1.0 ? 1.0 : 0.0;
  const double n = degree;
  return (t - knot) / n * basis(degree - 1, knot, t) +
         (knot + n + 1.0 - t) / n * basis(degree - 1, knot + 1.0, t);
}

/// Derivatives of a camera's pixel of a point.
struct Slopes {
  Eigen::Matrix<double, 2, kPerCamera> by_camera;
  Eigen::Matrix<double, 2, 3> by_point;
};

Slopes slopesOf(const geometry::Camera& camera,
                const Eigen::Vector3d& point,
                const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero()) {
  const geometry::Projection projection = geometry::projectionOf(camera, point).value();
  Slopes slopes;
  slopes.by_camera << projection.by_parameters.leftCols<kWaveTimeOffset>(),
      projection.by_point * velocity;
  slopes.by_point = projection.by_point;
  return slopes;
}

/// Derivatives of one residual: column and value.
using Row = std::vector<std::pair<Eigen::Index, double>>;

template <typename Values>
void append(Eigen::Index column, const Values& values, Row* row) {
  for (Eigen::Index k = 0; k < values.size(); ++k)
    row->emplace_back(column + k, values(k));
}

/// Linear equations of a wave, one by one. Unknowns: the cameras, the corners' displacements (2
/// each), the wand's length, the control points.
class Information {
 public:
  Information(const WaveScene& scene, const SimulatedWave& wave)
      : scene_(scene), wave_(wave), leds_(scene.length > 0.0 ? 2 : 1) {
    double end = -std::numeric_limits<double>::infinity();
    for (const SimulatedWave::View& view : wave.views) {
      start_ = std::min(start_, view.time);
      end = std::max(end, view.time);
    }
    if (!wave.views.empty())
      intervals_ = static_cast<Eigen::Index>(std::ceil((end - start_) / spacing_)) + 1;
  }

  void addViews(double pixel) {
    for (const SimulatedWave::View& view : wave_.views) {
      // Times are by the first camera's clock: its offset is no parameter.
      Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
      if (view.camera > 0)
        velocity = wave_.path.velocity(view.path_time, view.led);
      const Slopes slopes = slopesOf(wave_.cameras[view.camera],
                                     wave_.path.position(view.path_time, view.led), velocity);
      for (Eigen::Index r = 0; r < 2; ++r) {
        Row row;
        append(cameraColumn(view.camera), slopes.by_camera.row(r), &row);
        appendPath(view.time, view.led, slopes.by_point.row(r), &row);
        add(row, pixel);
      }
    }
  }

  void addLensPriors() {
    const square::Uncertainty& u = scene_.uncertainty;
    for (std::size_t i = 0; i < wave_.cameras.size(); ++i) {
      const geometry::Intrinsics& lens = wave_.cameras[i].intrinsics;
      const Eigen::Index at = cameraColumn(i);
      add({{at + kFx, 0.5 / lens.fx}, {at + kFy, 0.5 / lens.fy}}, u.focal);
      add({{at + kFx, 1.0 / lens.fx}, {at + kFy, -1.0 / lens.fy}}, u.aspect);
      add(principalPoint(i, kCx), u.principal_point);
      add(principalPoint(i, kCy), u.principal_point);
      add({{at + kK1, 1.0}}, u.k1);
    }
  }

  /// Times are by the first camera's clock.
  void addClockPriors() {
    for (std::size_t i = 0; i < wave_.cameras.size(); ++i)
      add({{cameraColumn(i) + kWaveTimeOffset, 1.0}}, i == 0 ? kGiven : kClockStddev);
  }

  /// Without square the first camera is the world.
  void addFirstCamera() {
    for (Eigen::Index k = 0; k < kPose; ++k)
      add({{cameraColumn(0) + k, 1.0}}, kGiven);
  }

  void addCornerPixels() {
    for (std::size_t i = 0; i < wave_.cameras.size(); ++i) {
      for (std::size_t c = 0; c < wave_.corners.size(); ++c) {
        const Slopes slopes = slopesOf(wave_.cameras[i], wave_.corners[c]);
        for (Eigen::Index r = 0; r < 2; ++r) {
          Row row;
          append(cameraColumn(i), slopes.by_camera.row(r), &row);
          append(cornerColumn(c), slopes.by_point.row(r).head<2>(), &row);
          add(row, scene_.uncertainty.pixel);
        }
      }
    }
  }

  void addCornerPriors() {
    for (Eigen::Index column = cornerColumn(0); column < cornerColumn(4); ++column)
      add({{column, 1.0}}, scene_.uncertainty.placement);
  }

  /// For those that nobody saw.
  void addControlPointPriors() {
    for (Eigen::Index column = controlColumn(0, 0); column < size(); ++column)
      add({{column, 1.0}}, kAnywhere);
  }

  void addWand() {
    add({{wandColumn(), 1.0}}, Wand().stddev);
    for (Eigen::Index i = 0; leds_ == 2 && i < intervals_; ++i) {
      const double time = start_ + spacing_ * static_cast<double>(i);
      const double path_time = time + wave_.views.front().path_time - wave_.views.front().time;
      const Eigen::RowVector3d direction =
          (wave_.path.position(path_time, 0) - wave_.path.position(path_time, 1)).normalized();
      Row row = {{wandColumn(), -1.0}};
      appendPath(time, 0, direction, &row);
      appendPath(time, 1, -direction, &row);
      add(row, kStick);
    }
  }

  Eigen::MatrixXd camerasCovariance() const {
    Eigen::SparseMatrix<double> slopes(size(), residuals_);
    slopes.setFromTriplets(slopes_.begin(), slopes_.end());
    const Eigen::SparseMatrix<double> matrix = slopes * slopes.transpose();
    // Parameters of very different units.
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(scaled);
    const Eigen::Index first = cornerColumn(0);
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(size(), first);
    const Eigen::MatrixXd columns = solver.solve(unit);
    return scale.head(first).asDiagonal() * columns.topRows(first) * scale.head(first).asDiagonal();
  }

 private:
  static Eigen::Index cameraColumn(std::size_t camera) {
    return kPerCamera * static_cast<Eigen::Index>(camera);
  }
  Eigen::Index cornerColumn(std::size_t corner) const {
    return cameraColumn(wave_.cameras.size()) + 2 * static_cast<Eigen::Index>(corner);
  }
  Eigen::Index wandColumn() const { return cornerColumn(4); }
  Eigen::Index controlColumn(Eigen::Index control, Eigen::Index led) const {
    return wandColumn() + 1 + 3 * (leds_ * control + led);
  }

  /// Number of unknowns.
  Eigen::Index size() const { return controlColumn(intervals_ > 0 ? intervals_ + 3 : 0, 0); }

  /// Row of the prior of a principal point's coordinate. All of them have the covariance
  /// s^2 I + S^2 1 1^T: an error s of each, an offset S that they share. These rows are its inverse
  /// square root times s: I - share 1 1^T.
  Row principalPoint(std::size_t camera, Eigen::Index coordinate) const {
    const auto count = static_cast<double>(wave_.cameras.size());
    const square::Uncertainty& u = scene_.uncertainty;
    const double all = std::hypot(u.principal_point, std::sqrt(count) * u.shared_principal_point);
    const double share = (1.0 - u.principal_point / all) / count;
    Row row;
    for (std::size_t i = 0; i < wave_.cameras.size(); ++i)
      row.emplace_back(cameraColumn(i) + coordinate, (i == camera ? 1.0 : 0.0) - share);
    return row;
  }

  /// Derivatives by the control points, from those by the path's position at a time.
  void appendPath(double time,
                  Eigen::Index led,
                  const Eigen::RowVector3d& by_position,
                  Row* row) const {
    const double t = (time - start_) / spacing_;
    const auto first = static_cast<Eigen::Index>(t);
    for (Eigen::Index k = first; k < first + 4; ++k)
      append(controlColumn(k, led), basis(3, static_cast<double>(k - 3), t) * by_position, row);
  }

  void add(const Row& row, double stddev) {
    for (const auto& [column, slope] : row)
      slopes_.emplace_back(column, residuals_, slope / stddev);
    ++residuals_;
  }

  const WaveScene& scene_;
  const SimulatedWave& wave_;
  const double spacing_ = WaveOptions().knot_spacing;
  Eigen::Index leds_;
  double start_ = std::numeric_limits<double>::infinity();
  Eigen::Index intervals_ = 0;
  // Derivatives of the residuals (columns) by the unknowns (rows), over their standard deviations.
  std::vector<Eigen::Triplet<double>> slopes_;
  Eigen::Index residuals_ = 0;
};

/// RMS of the points' errors by causes of this covariance, before and after an alignment.
VolumeError rmsOf(const Eigen::MatrixXd& by_causes,
                  const Eigen::MatrixXd& covariance,
                  const std::vector<Eigen::Vector3d>& points) {
  const auto rms = [&](const Eigen::MatrixXd& a) {
    return std::sqrt((a * covariance).cwiseProduct(a).sum() / static_cast<double>(points.size()));
  };
  const Eigen::MatrixXd motions = bundle::similarityMotions(points);
  const auto aligned = [&](const Eigen::MatrixXd& along) {
    return rms(by_causes - along * (geometry::pseudoInverse(along) * by_causes));
  };
  return {rms(by_causes), aligned(motions.leftCols(6)), aligned(motions)};
}

/// How the points move with the parameters of the cameras that see them.
Eigen::MatrixXd byCameras(const std::vector<geometry::Camera>& cameras,
                          const std::vector<Eigen::Vector3d>& points) {
  geometry::Rig rig;
  for (const geometry::Camera& camera : cameras)
    rig.cameras.emplace_back().camera = camera;
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(points.size()),
                            kPerCamera * static_cast<Eigen::Index>(cameras.size()));
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Eigen::MatrixXd slopes =
        geometry::pointByParameters(rig, points[p], geometry::camerasSeeing(rig, points[p]))
            .value();
    for (std::size_t i = 0; i < cameras.size(); ++i)
      result.block<3, kWaveTimeOffset>(3 * static_cast<Eigen::Index>(p),
                                       kPerCamera * static_cast<Eigen::Index>(i)) =
          slopes.middleCols<kWaveTimeOffset>(geometry::firstParameter(i));
  }
  return result;
}

}  // namespace

VolumeError volumeError(const Eigen::Matrix3Xd& errors,
                        const std::vector<Eigen::Vector3d>& points) {
  return rmsOf(Eigen::Map<const Eigen::VectorXd>(errors.data(), errors.size()),
               Eigen::MatrixXd::Identity(1, 1), points);
}

WaveBound waveBound(const WaveScene& scene,
                    const SimulatedWave& wave,
                    double pixel,
                    const std::vector<Eigen::Vector3d>& points) {
  Information information(scene, wave);
  information.addViews(pixel);
  information.addLensPriors();
  information.addClockPriors();
  information.addCornerPriors();
  if (scene.square)
    information.addCornerPixels();
  else
    information.addFirstCamera();
  information.addWand();
  information.addControlPointPriors();
  const Eigen::MatrixXd covariance = information.camerasCovariance();
  return {covariance, rmsOf(byCameras(wave.cameras, points), covariance, points)};
}

std::optional<Eigen::Matrix3d> pointBound(const std::vector<geometry::Camera>& cameras,
                                          const Eigen::MatrixXd& covariance,
                                          const Eigen::Vector3d& point,
                                          double pixel) {
  std::vector<std::size_t> seeing;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].sees(point))
      seeing.push_back(i);
  }
  if (seeing.size() < 2)
    return std::nullopt;
  const auto rows = 2 * static_cast<Eigen::Index>(seeing.size());
  Eigen::MatrixXd by_cameras = Eigen::MatrixXd::Zero(rows, covariance.rows());
  Eigen::MatrixXd by_point(rows, 3);
  for (std::size_t k = 0; k < seeing.size(); ++k) {
    const auto row = 2 * static_cast<Eigen::Index>(k);
    const auto column = kPerCamera * static_cast<Eigen::Index>(seeing[k]);
    const Slopes slopes = slopesOf(cameras[seeing[k]], point);
    by_cameras.block<2, kPerCamera>(row, column) = slopes.by_camera;
    by_point.middleRows<2>(row) = slopes.by_point;
  }
  const Eigen::MatrixXd noise = by_cameras * covariance * by_cameras.transpose() +
                                pixel * pixel * Eigen::MatrixXd::Identity(rows, rows);
  const Eigen::Matrix3d information =
      by_point.transpose() * geometry::solveSymmetric(noise, by_point);
  return information.inverse().eval();
}

}  // namespace wiimote_tracker::wave
