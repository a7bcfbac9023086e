// How near the solution is to the truth, and whether its covariance says so. All simulated.

#include "adjust/opencv.h"
#include "square/expected_error.h"
#include "wiimote_tracker_calibration/square/branches.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include "simulated_square.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

#include <iostream>

namespace wiimote_tracker::square {
namespace {

/// Cramer-Rao bound of a pose with known lens and corners (6x6: position, rotation), by numerical
/// differentiation of the projection.
Eigen::Matrix<double, 6, 6> poseBound(const geometry::Camera& camera,
                                      const Corners& corners,
                                      double stddev) {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr double kStep = 1e-6;
  for (const Eigen::Vector3d& corner : corners) {
    Eigen::Matrix<double, 2, 6> jacobian;
    for (int axis = 0; axis < 6; ++axis) {
      Eigen::Vector2d pixel[2];
      for (int side = 0; side < 2; ++side) {
        geometry::Camera moved = camera;
        const double step = side == 0 ? -kStep : kStep;
        if (axis < 3)
          moved.world_from_camera.translation()[axis] += step;
        else
          moved.world_from_camera.linear() =
              Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(axis - 3)) *
              camera.world_from_camera.linear();
        pixel[side] = moved.project(corner).value();
      }
      jacobian.col(axis) = (pixel[1] - pixel[0]) / (2.0 * kStep);
    }
    information += jacobian.transpose() * jacobian / (stddev * stddev);
  }
  return information.inverse();
}

TEST(ExtensiveAccuracy, OneCameraReachesTheCramerRaoBoundAndOpencv) {
  constexpr int kTrials = 1000;
  constexpr double kPixel = 0.5;
  const SquareLayout layout = paperSquare();
  const Corners corners = layout.corners(true);
  Random random(11);
  Uncertainty errors = noErrors();
  errors.pixel = kPixel;
  double squared = 0.0;
  double opencv_squared = 0.0;
  double bound = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const std::vector<Eigen::Isometry3d> poses = {paperRig()[0]};
  for (int trial = 0; trial < kTrials; ++trial) {
    const SimulatedSquare simulated = simulateSquare(poses, layout, true, errors, false, random);
    const SquareModel model(simulated.sightings, layout, true, Uncertainty());
    const std::vector<Branch> branches = findBranches(model, 0);
    ASSERT_FALSE(branches.empty());
    const Eigen::Vector3d truth = simulated.truth[0].center();
    const Eigen::Vector3d error = branches[0].world_from_camera.translation() - truth;
    squared += error.squaredNorm();
    sum += error;
    bound += poseBound(simulated.truth[0], corners, kPixel).topLeftCorner<3, 3>().trace();

    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> pixels;
    for (std::size_t c = 0; c < 4; ++c) {
      points.emplace_back(corners[c].x(), corners[c].y(), corners[c].z());
      pixels.emplace_back(simulated.sightings[0].corners[c]->x(),
                          simulated.sightings[0].corners[c]->y());
    }
    const geometry::Intrinsics lens;
    const cv::Matx33d matrix(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
    cv::Mat rotation;
    cv::Mat translation;
    ASSERT_TRUE(cv::solvePnP(points, pixels, matrix, cv::noArray(), rotation, translation, false,
                             cv::SOLVEPNP_ITERATIVE));
    const Eigen::Isometry3d pose = adjust::poseFromCv(rotation, translation).inverse();
    opencv_squared += (pose.translation() - truth).squaredNorm();
  }
  const double rms = std::sqrt(squared / kTrials);
  const double opencv_rms = std::sqrt(opencv_squared / kTrials);
  const double bound_rms = std::sqrt(bound / kTrials);
  std::cout << "one camera, 0.5 px: position RMS " << 1000 * rms << " mm, OpenCV ITERATIVE "
            << 1000 * opencv_rms << " mm, bound " << 1000 * bound_rms << " mm, bias "
            << 1000 * (sum / kTrials).norm() << " mm\n";
  // Nearly one degree of freedom dominates: the RMS of 1000 trials scatters by
  // 1/sqrt(2 * 1000), 2.2 %; four times that.
  EXPECT_NEAR(rms / bound_rms, 1.0, 0.09);
  EXPECT_NEAR(rms / opencv_rms, 1.0, 1e-3);
  EXPECT_LT((sum / kTrials).norm(), 4.0 * bound_rms / std::sqrt(kTrials));
}

/// True minus estimated parameters of all cameras, in the order of the covariance.
Eigen::VectorXd parameterErrors(const SimulatedSquare& simulated, const geometry::Rig& rig) {
  Eigen::VectorXd errors(11 * static_cast<Eigen::Index>(rig.cameras.size()));
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    errors.segment<11>(11 * static_cast<Eigen::Index>(i)) =
        parameterDifference(rig.cameras[i].camera, simulated.truth[i]).head<11>();
  return errors;
}

/// The covariance without the rows of the parameters that were held.
Eigen::MatrixXd withoutHeld(const Eigen::MatrixXd& covariance) {
  const Eigen::Index cameras = covariance.rows() / 16;
  Eigen::MatrixXd result(11 * cameras, 11 * cameras);
  for (Eigen::Index i = 0; i < cameras; ++i) {
    for (Eigen::Index j = 0; j < cameras; ++j)
      result.block<11, 11>(11 * i, 11 * j) = covariance.block<11, 11>(16 * i, 16 * j);
  }
  return result;
}

double normalizedSquare(const Eigen::VectorXd& errors, const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::VectorXd scaled = scale.asDiagonal() * errors;
  return geometry::squaredMahalanobis(scaled, correlation);
}

/// Mean normalised estimation error squared per dimension, of everything and of one camera's pose.
struct Nees {
  double all = 0.0;
  double all_stddev = 0.0;
  double pose = 0.0;
  double pose_stddev = 0.0;
};

Nees neesOf(Method method, const Uncertainty& uncertainty, int rigs) {
  SolveOptions options;
  options.method = method;
  options.uncertainty = uncertainty;
  Random random(23);
  Nees nees;
  double dimensions = 0.0;
  double pose_dimensions = 0.0;
  for (int trial = 0; trial < rigs; ++trial) {
    const SquareLayout layout = paperSquare();
    const auto count = static_cast<std::size_t>(2 + trial % 3);
    const auto poses = posesAround(layout, true, count, random);
    const SimulatedSquare simulated =
        simulateSquare(poses, layout, true, uncertainty, true, random);
    const geometry::Rig rig = solveSquare(layout, simulated.sightings, options).rig;
    EXPECT_EQ(rig.covariance.rows(), static_cast<Eigen::Index>(16 * count));
    EXPECT_EQ(rig.covariance, rig.covariance.transpose());
    const Eigen::VectorXd errors = parameterErrors(simulated, rig);
    nees.all += normalizedSquare(errors, withoutHeld(rig.covariance));
    dimensions += static_cast<double>(errors.size());
    nees.pose += normalizedSquare(errors.head<6>(), rig.covariance.topLeftCorner<6, 6>());
    pose_dimensions += 6.0;
  }
  nees.all /= dimensions;
  nees.pose /= pose_dimensions;
  // Chi-square: the sum of n squares scatters by sqrt(2 n).
  nees.all_stddev = std::sqrt(2.0 / dimensions);
  nees.pose_stddev = std::sqrt(2.0 / pose_dimensions);
  return nees;
}

class Consistency : public ::testing::TestWithParam<Method> {};

TEST_P(Consistency, JointCovarianceIsExactForSmallErrors) {
  Uncertainty small;
  for (double* stddev :
       {&small.pixel, &small.placement, &small.focal, &small.aspect, &small.principal_point,
        &small.shared_principal_point, &small.k1, &small.gravity})
    *stddev *= 0.1;
  const Nees nees = neesOf(GetParam(), small, 200);
  std::cout << "NEES per dimension, a tenth of the errors: all " << nees.all << ", one pose "
            << nees.pose << '\n';
  EXPECT_NEAR(nees.all, 1.0, 4.0 * nees.all_stddev);
  EXPECT_NEAR(nees.pose, 1.0, 4.0 * nees.pose_stddev);
}

TEST_P(Consistency, CovarianceOfThePoseHoldsForErrorsOfRealSize) {
  // Not so the covariance of everything at once: lenses that are off by 3 % and 15 px move the
  // narrowest directions (pixels of the corners, known to 0.2 px) beyond what is linear.
  const Nees nees = neesOf(GetParam(), Uncertainty(), 200);
  std::cout << "NEES per dimension: all " << nees.all << ", one pose " << nees.pose << '\n';
  EXPECT_NEAR(nees.pose, 1.0, 4.0 * nees.pose_stddev);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         Consistency,
                         ::testing::Values(Method::kJoint, Method::kPerCamera));

/// Errors of triangulated points, as they are and after alignment [m^2], summed.
struct PointErrors {
  double absolute = 0.0;
  double rigid = 0.0;
  double similarity = 0.0;
  double expected = 0.0;
  int count = 0;

  static double rms(double sum, int count) { return 1000.0 * std::sqrt(sum / count); }
  void print(const char* name) const {
    std::cout << name << ": absolute " << rms(absolute, count) << ", rigid " << rms(rigid, count)
              << ", similarity " << rms(similarity, count) << ", expected " << rms(expected, count)
              << " mm RMS\n";
  }
};

Eigen::Matrix3Xd triangulateAll(const SimulatedSquare& simulated,
                                const geometry::Rig& rig,
                                const Eigen::Matrix3Xd& points) {
  Eigen::Matrix3Xd measured(3, points.cols());
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    std::vector<geometry::Observation> observations;
    for (std::size_t i = 0; i < rig.cameras.size(); ++i)
      observations.push_back(
          {&rig.cameras[i].camera, simulated.truth[i].project(points.col(k)).value()});
    measured.col(k) =
        geometry::triangulate(observations, geometry::TriangulationOptions()).value().position;
  }
  return measured;
}

Eigen::Matrix3Xd aligned(const Eigen::Matrix3Xd& points, const Eigen::Matrix4d& transform) {
  return (transform.topLeftCorner<3, 3>() * points).colwise() +
         Eigen::Vector3d(transform.topRightCorner<3, 1>());
}

void addErrors(const SimulatedSquare& simulated, const geometry::Rig& rig, PointErrors* errors) {
  // The paper's ten points, z up; the alignment is fitted on others.
  Eigen::Matrix3Xd points(3, 10);
  points << 0, 2.5, 2.5, 0, 0, 2.5, 2.5, 0, 1.25, 1.25,  //
      0, 0, 2.5, 2.5, 0, 0, 2.5, 2.5, 1.25, 1.25,        //
      0, 0, 0, 0, 2.5, 2.5, 2.5, 2.5, 0, 1.5;
  Eigen::Matrix3Xd others(3, 27);
  for (int k = 0; k < 27; ++k)
    others.col(k) = 0.85 * Eigen::Vector3i(k % 3, k / 3 % 3, k / 9).cast<double>();
  others.array() += 0.4;
  const Eigen::Matrix3Xd measured = triangulateAll(simulated, rig, points);
  const Eigen::Matrix3Xd measured_others = triangulateAll(simulated, rig, others);
  errors->absolute += (measured - points).squaredNorm();
  errors->rigid +=
      (aligned(measured, Eigen::umeyama(measured_others, others, false)) - points).squaredNorm();
  errors->similarity +=
      (aligned(measured, Eigen::umeyama(measured_others, others, true)) - points).squaredNorm();
  std::vector<Eigen::Vector3d> list;
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    list.emplace_back(points.col(k));
  errors->expected += 10.0 * std::pow(expectedError(rig, list), 2.0);
  errors->count += 10;
}

TEST(ExtensiveAccuracy, JointIsMoreAccurateThanPerCameraAndBothStateTheirError) {
  // The paper's rig, 2 and 4 cameras; 5 mm corners, and lenses as uncertain as assumed.
  for (const std::size_t count : {std::size_t{2}, std::size_t{4}}) {
    PointErrors errors[2];
    Random random(29);
    constexpr int kRigs = 60;
    for (int trial = 0; trial < kRigs; ++trial) {
      std::vector<Eigen::Isometry3d> poses = paperRig();
      poses.resize(count);
      const SimulatedSquare simulated =
          simulateSquare(poses, paperSquare(), true, Uncertainty(), true, random);
      for (const Method method : {Method::kJoint, Method::kPerCamera}) {
        SolveOptions options;
        options.method = method;
        addErrors(simulated, solveSquare(paperSquare(), simulated.sightings, options).rig,
                  &errors[method == Method::kPerCamera]);
      }
    }
    std::cout << "the paper's ten points, " << count << " cameras, " << kRigs << " rigs\n";
    errors[0].print("  joint     ");
    errors[1].print("  per camera");
    EXPECT_LT(errors[0].absolute, errors[1].absolute);
    for (const PointErrors& error : errors) {
      // 60 rigs with effectively ten or more independent errors each: 2.9 % per standard
      // deviation of the RMS; four times that, and a little for what is not linear.
      EXPECT_NEAR(std::sqrt(error.expected / error.absolute), 1.0, 0.16);
    }
  }
}

TEST(SquareModel, DegreesOfFreedomAreWhatIsMeasuredLessThePoses) {
  Random random(1);
  SquareLayout layout = paperSquare();
  const std::vector<Eigen::Isometry3d> poses = paperRig();
  const SimulatedSquare simulated = simulateSquare(poses, layout, true, noErrors(), true, random);
  const auto freedom = [&](const Uncertainty& stated) {
    const SquareModel model(simulated.sightings, layout, true, stated);
    return model.degreesOfFreedom(model.start(poses));
  };
  Uncertainty stated;
  const int least = static_cast<int>(poses.size()) * (4 * 2 + 2 - 6);  // with gravity
  EXPECT_EQ(freedom(stated), least);
  layout.lengths.push_back({0, 2, 3.5});
  EXPECT_EQ(freedom(stated), least + 1);
  stated.unknown_corner = 0;
  EXPECT_EQ(freedom(stated), least + 1 - 2);
}

}  // namespace
}  // namespace wiimote_tracker::square
