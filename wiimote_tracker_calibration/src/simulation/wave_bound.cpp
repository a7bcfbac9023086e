#include "wiimote_tracker_calibration/simulation/wave_bound.h"

#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wiimote_tracker::wave {

namespace {

constexpr Eigen::Index kPerCamera = 12;
constexpr Eigen::Index kTimeOffset = 11;
constexpr double kSteps[kPerCamera] = {1e-6, 1e-6, 1e-6, 1e-5, 1e-5, 1e-5,
                                       1e-3, 1e-3, 1e-3, 1e-3, 1e-6, 0.0};

geometry::Camera changed(geometry::Camera camera, Eigen::Index parameter, double step) {
  geometry::Intrinsics& lens = camera.intrinsics;
  if (parameter < 3)
    camera.world_from_camera.linear() = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(parameter)) *
                                        camera.world_from_camera.linear();
  else if (parameter < 6)
    camera.world_from_camera.translation()[parameter - 3] += step;
  else
    *std::array<double*, 5>{&lens.fx, &lens.fy, &lens.cx, &lens.cy,
                            &lens.distortion[0]}[static_cast<std::size_t>(parameter - 6)] += step;
  return camera;
}

/// B-spline of a degree on whole-numbered knots, by Cox and de Boor's recursion.
double basis(int degree, double knot, double t) {
  if (degree == 0)
    return t >= knot && t < knot + 1.0 ? 1.0 : 0.0;
  const double n = degree;
  return (t - knot) / n * basis(degree - 1, knot, t) +
         (knot + n + 1.0 - t) / n * basis(degree - 1, knot + 1.0, t);
}

/// Sparse normal equations, row by row.
class Information {
 public:
  explicit Information(Eigen::Index size) : matrix_(size, size) {}

  void add(const std::vector<std::pair<Eigen::Index, double>>& row, double stddev) {
    for (const auto& [i, a] : row) {
      for (const auto& [j, b] : row)
        entries_.emplace_back(i, j, a * b / (stddev * stddev));
    }
  }

  /// Covariance of the first parameters.
  Eigen::MatrixXd inverse(Eigen::Index first) {
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    // Parameters of very different units.
    const Eigen::VectorXd scale = matrix_.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * matrix_ * scale.asDiagonal();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(scaled);
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(matrix_.rows(), first);
    const Eigen::MatrixXd columns = solver.solve(unit);
    return scale.head(first).asDiagonal() * columns.topRows(first) * scale.head(first).asDiagonal();
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::SparseMatrix<double> matrix_;
};

using PixelByCamera = Eigen::Matrix<double, 2, kPerCamera>;

PixelByCamera byCamera(const geometry::Camera& camera, const Eigen::Vector3d& point) {
  PixelByCamera result = PixelByCamera::Zero();
  for (Eigen::Index k = 0; k < kTimeOffset; ++k)
    result.col(k) = (*changed(camera, k, kSteps[k]).project(point) -
                     *changed(camera, k, -kSteps[k]).project(point)) /
                    (2.0 * kSteps[k]);
  return result;
}

Eigen::Matrix<double, 2, 3> byPoint(const geometry::Camera& camera, const Eigen::Vector3d& point) {
  const double kStep = 1e-5;
  Eigen::Matrix<double, 2, 3> result;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    result.col(axis) =
        (*camera.project(point + step) - *camera.project(point - step)) / (2.0 * kStep);
  }
  return result;
}

}  // namespace

std::vector<Eigen::Vector3d> cubePoints(const std::vector<geometry::Camera>& truth) {
  std::vector<Eigen::Vector3d> points;
  const int kSteps = 6;
  for (int x = 0; x < kSteps; ++x) {
    for (int y = 0; y < kSteps; ++y) {
      for (int z = 0; z < kSteps; ++z) {
        const Eigen::Vector3d point = 2.5 / (kSteps - 1) * Eigen::Vector3d(x, y, z);
        if (std::all_of(truth.begin(), truth.end(),
                        [&](const geometry::Camera& camera) { return camera.sees(point); }))
          points.push_back(point);
      }
    }
  }
  return points;
}

Eigen::Matrix3Xd pointErrors(const std::vector<geometry::Camera>& truth,
                             const std::vector<geometry::Camera>& estimate,
                             const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd errors(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<geometry::Observation> observations;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (truth[i].sees(points[p]))
        observations.push_back({&estimate[i], *truth[i].project(points[p])});
    }
    const auto point = geometry::triangulate(observations, geometry::TriangulationOptions());
    errors.col(static_cast<Eigen::Index>(p)) =
        point ? Eigen::Vector3d(point->position - points[p])
              : Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  }
  return errors;
}

Eigen::Matrix3Xd aligned(const Eigen::Matrix3Xd& errors,
                         const std::vector<Eigen::Vector3d>& points,
                         bool with_scale) {
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(errors.size(), with_scale ? 7 : 6);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(p);
    const Eigen::Vector3d r = points[p] - Eigen::Vector3d::Constant(1.25);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      motions(row + axis, axis) = 1.0;
      motions.block<3, 1>(row, 3 + axis) = Eigen::Vector3d::Unit(axis).cross(r);
    }
    if (with_scale)
      motions.block<3, 1>(row, 6) = r;
  }
  const Eigen::VectorXd all = Eigen::Map<const Eigen::VectorXd>(errors.data(), errors.size());
  const Eigen::VectorXd rest = all - motions * motions.householderQr().solve(all);
  return Eigen::Map<const Eigen::Matrix3Xd>(rest.data(), 3, errors.cols());
}

VolumeError volumeError(const Eigen::Matrix3Xd& errors,
                        const std::vector<Eigen::Vector3d>& points) {
  const double count = static_cast<double>(points.size());
  return {std::sqrt(errors.squaredNorm() / count),
          std::sqrt(aligned(errors, points, false).squaredNorm() / count),
          std::sqrt(aligned(errors, points, true).squaredNorm() / count)};
}

WaveBound waveBound(const WaveScene& scene,
                    const SimulatedWave& wave,
                    double knot_spacing,
                    double pixel,
                    double wand_stddev,
                    const std::vector<Eigen::Vector3d>& points) {
  const auto cameras = static_cast<Eigen::Index>(wave.cameras.size());
  const Eigen::Index camera_columns = kPerCamera * cameras;
  const Eigen::Index wand_column = camera_columns + 8;
  const Eigen::Index path_column = wand_column + 1;
  double start = std::numeric_limits<double>::infinity();
  double end = -start;
  for (const SimulatedWave::View& view : wave.views) {
    start = std::min(start, view.time);
    end = std::max(end, view.time);
  }
  const Eigen::Index intervals =
      wave.views.empty() ? 0
                         : static_cast<Eigen::Index>(std::ceil((end - start) / knot_spacing)) + 1;
  const Eigen::Index controls = intervals > 0 ? intervals + 3 : 0;
  const Eigen::Index leds = scene.length > 0.0 ? 2 : 1;
  Information information(path_column + 3 * leds * controls);

  // A path's position at a time as weights of its control points.
  const auto weights = [&](double time) {
    const double t = (time - start) / knot_spacing;
    const auto first = static_cast<Eigen::Index>(t);
    std::array<std::pair<Eigen::Index, double>, 4> result;
    for (Eigen::Index k = 0; k < 4; ++k)
      result[static_cast<std::size_t>(k)] = {first + k,
                                             basis(3, static_cast<double>(first + k - 3), t)};
    return result;
  };
  const auto column = [&](Eigen::Index control, Eigen::Index led, Eigen::Index axis) {
    return path_column + 3 * (leds * control + led) + axis;
  };
  using Row = std::vector<std::pair<Eigen::Index, double>>;
  for (const SimulatedWave::View& view : wave.views) {
    const geometry::Camera& camera = wave.cameras[view.camera];
    const Eigen::Vector3d point = wave.path.position(view.path_time, view.led);
    PixelByCamera by_camera = byCamera(camera, point);
    const Eigen::Matrix<double, 2, 3> by_point = byPoint(camera, point);
    if (view.camera > 0)
      by_camera.col(kTimeOffset) = by_point * wave.path.velocity(view.path_time, view.led);
    for (Eigen::Index r = 0; r < 2; ++r) {
      Row row;
      for (Eigen::Index k = 0; k < kPerCamera; ++k) {
        if (by_camera(r, k) != 0.0)
          row.emplace_back(kPerCamera * static_cast<Eigen::Index>(view.camera) + k,
                           by_camera(r, k));
      }
      for (const auto& [control, weight] : weights(view.time)) {
        for (Eigen::Index axis = 0; axis < 3; ++axis)
          row.emplace_back(column(control, view.led, axis), weight * by_point(r, axis));
      }
      information.add(row, pixel);
    }
  }

  const square::Uncertainty& u = scene.uncertainty;
  for (Eigen::Index i = 0; i < cameras; ++i) {
    const geometry::Camera& camera = wave.cameras[static_cast<std::size_t>(i)];
    const geometry::Intrinsics& lens = camera.intrinsics;
    const Eigen::Index at = kPerCamera * i;
    information.add({{at + 6, 0.5 / lens.fx}, {at + 7, 0.5 / lens.fy}}, u.focal);
    information.add({{at + 6, 1.0 / lens.fx}, {at + 7, -1.0 / lens.fy}}, u.aspect);
    information.add({{at + 8, 1.0}}, u.principal_point);
    information.add({{at + 9, 1.0}}, u.principal_point);
    information.add({{at + 10, 1.0}}, u.k1);
    information.add({{at + kTimeOffset, 1.0}}, i == 0 ? 1e-9 : 0.05);
    // Without square the first camera is the world.
    for (Eigen::Index k = 0; !scene.square && i == 0 && k < 6; ++k)
      information.add({{at + k, 1.0}}, 1e-9);
    for (Eigen::Index c = 0; scene.square && c < 4; ++c) {
      const auto& corner = wave.corners[static_cast<std::size_t>(c)];
      const PixelByCamera by_camera = byCamera(camera, corner);
      const Eigen::Matrix<double, 2, 3> by_point = byPoint(camera, corner);
      for (Eigen::Index r = 0; r < 2; ++r) {
        Row row;
        for (Eigen::Index k = 0; k < kTimeOffset; ++k)
          row.emplace_back(at + k, by_camera(r, k));
        for (Eigen::Index axis = 0; axis < 2; ++axis)
          row.emplace_back(camera_columns + 2 * c + axis, by_point(r, axis));
        information.add(row, u.pixel);
      }
    }
  }
  for (Eigen::Index c = 0; c < 8; ++c)
    information.add({{camera_columns + c, 1.0}}, u.placement);
  information.add({{wand_column, 1.0}}, wand_stddev);
  for (Eigen::Index i = 0; leds == 2 && i < intervals; ++i) {
    const double kStick = 0.0002;
    const double time = start + knot_spacing * static_cast<double>(i);
    const double path_time =
        time - start + wave.views.front().path_time - (wave.views.front().time - start);
    const Eigen::Vector3d direction =
        (wave.path.position(path_time, 0) - wave.path.position(path_time, 1)).normalized();
    Row row = {{wand_column, -1.0}};
    for (const auto& [control, weight] : weights(time)) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        row.emplace_back(column(control, 0, axis), weight * direction[axis]);
        row.emplace_back(column(control, 1, axis), -weight * direction[axis]);
      }
    }
    information.add(row, kStick);
  }
  // Control points that nobody saw.
  for (Eigen::Index k = path_column; k < path_column + 3 * leds * controls; ++k)
    information.add({{k, 1.0}}, 10.0);

  WaveBound bound;
  bound.covariance = information.inverse(camera_columns);

  // Point errors from parameter errors, and what alignment leaves of them.
  Eigen::MatrixXd errors(3 * static_cast<Eigen::Index>(points.size()), camera_columns);
  Eigen::MatrixXd rigid = errors;
  Eigen::MatrixXd similarity = errors;
  errors.setZero();
  rigid.setZero();
  similarity.setZero();
  for (Eigen::Index k = 0; k < camera_columns; ++k) {
    const Eigen::Index parameter = k % kPerCamera;
    if (parameter == kTimeOffset)
      continue;
    const auto i = static_cast<std::size_t>(k / kPerCamera);
    const double step = kSteps[parameter];
    std::vector<geometry::Camera> plus = wave.cameras;
    std::vector<geometry::Camera> minus = wave.cameras;
    plus[i] = changed(plus[i], parameter, step);
    minus[i] = changed(minus[i], parameter, -step);
    const Eigen::Matrix3Xd slope =
        (pointErrors(wave.cameras, plus, points) - pointErrors(wave.cameras, minus, points)) /
        (2.0 * step);
    const auto store = [&](const Eigen::Matrix3Xd& from, Eigen::MatrixXd* to) {
      to->col(k) = Eigen::Map<const Eigen::VectorXd>(from.data(), from.size());
    };
    store(slope, &errors);
    store(aligned(slope, points, false), &rigid);
    store(aligned(slope, points, true), &similarity);
  }
  const auto rms = [&](const Eigen::MatrixXd& a) {
    return std::sqrt((a * bound.covariance).cwiseProduct(a).sum() /
                     static_cast<double>(points.size()));
  };
  bound.volume = {rms(errors), rms(rigid), rms(similarity)};
  return bound;
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
    by_cameras.block<2, kPerCamera>(row, column) = byCamera(cameras[seeing[k]], point);
    by_point.middleRows<2>(row) = byPoint(cameras[seeing[k]], point);
  }
  const Eigen::MatrixXd noise = by_cameras * covariance * by_cameras.transpose() +
                                pixel * pixel * Eigen::MatrixXd::Identity(rows, rows);
  const Eigen::Matrix3d information = by_point.transpose() * noise.ldlt().solve(by_point).eval();
  return information.inverse().eval();
}

}  // namespace wiimote_tracker::wave
