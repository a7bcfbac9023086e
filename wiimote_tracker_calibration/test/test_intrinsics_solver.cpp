#include "board_lenses.h"
#include "expect_says.h"
#include "refusal_of.h"

#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::intrinsics {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;

Vector9d parameters(const geometry::Intrinsics& camera) {
  Vector9d p;
  p << camera.fx, camera.fy, camera.cx, camera.cy, camera.distortion[0], camera.distortion[1],
      camera.distortion[2], camera.distortion[3], camera.distortion[4];
  return p;
}

geometry::Intrinsics moved(geometry::Intrinsics camera, int parameter, double step) {
  double* const values[] = {&camera.fx,
                            &camera.fy,
                            &camera.cx,
                            &camera.cy,
                            &camera.distortion[0],
                            &camera.distortion[1],
                            &camera.distortion[2],
                            &camera.distortion[3],
                            &camera.distortion[4]};
  *values[parameter] += step;
  return camera;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, int parameter, double step) {
  Eigen::Isometry3d result = pose;
  if (parameter < 3)
    result.linear() = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(parameter)).toRotationMatrix() *
                      pose.linear();
  else
    result.translation()(parameter - 3) += step;
  return result;
}

/// Cramer-Rao bound of the first `lens` parameters, poses unknown: the whole information matrix
/// from numerical derivatives of the geometry core's camera, inverted as it is.
Eigen::MatrixXd cramerRaoBound(const geometry::Intrinsics& camera,
                               const std::vector<Eigen::Isometry3d>& poses,
                               const Samples& samples,
                               int lens,
                               double sigma) {
  const int size = lens + 6 * static_cast<int>(poses.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd steps = Eigen::VectorXd::Constant(size, 1e-5);
  steps.head(4).setConstant(1e-2);
  for (std::size_t view = 0; view < poses.size(); ++view) {
    for (int led = 0; led < kBoardLeds; ++led) {
      if (!samples.views[view].pixels[static_cast<std::size_t>(led)])
        continue;
      Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(2, size);
      const auto pixel = [&](int k, double step) {
        const int pose_parameter = k - lens - 6 * static_cast<int>(view);
        return projected(k < lens ? moved(camera, k, step) : camera,
                         k < lens ? poses[view] : moved(poses[view], pose_parameter, step), led);
      };
      for (int k = 0; k < size; ++k) {
        const bool has_part = k < lens || (k - lens) / 6 == static_cast<int>(view);
        if (has_part)
          derivative.col(k) = (pixel(k, steps(k)) - pixel(k, -steps(k))) / (2.0 * steps(k));
      }
      information += derivative.transpose() * derivative;
    }
  }
  const Eigen::MatrixXd inverse = geometry::inverseOfInformation(information).value();
  return sigma * sigma * inverse.topLeftCorner(lens, lens);
}

// Of pixels with noise of 0.5 px, rounded to whole ones [px].
const double kSigma = std::sqrt(0.25 + 1.0 / 12.0);

/// Solutions from the same poses, each with other noise, held against the bound.
struct Runs {
  Eigen::VectorXd errors;     ///< RMS of each parameter, over its bound.
  Eigen::VectorXd stated;     ///< The same of the standard deviations that the solutions state.
  double nees = 0.0;          ///< Mean, per parameter.
  double pixel_stddev = 0.0;  ///< RMS of the estimates [px].
};

/// @param lens how many parameters `options` lets the solver estimate.
Runs solveOften(int count,
                const geometry::Intrinsics& camera,
                const std::vector<Eigen::Isometry3d>& poses,
                const Samples& exact,
                const SolverOptions& options,
                int lens,
                std::mt19937& random) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(lens);
  Eigen::VectorXd variances = Eigen::VectorXd::Zero(lens);
  double nees = 0.0;
  double pixel_variance = 0.0;
  for (int run = 0; run < count; ++run) {
    Samples samples = exact;
    for (std::size_t view = 0; view < poses.size(); ++view)
      samples.views[view] = simulatedView(camera, poses[view], 0.5, random);
    const IntrinsicsSolution solution = solveIntrinsics(samples, options);
    const Eigen::VectorXd error = (parameters(solution.intrinsics) - parameters(camera)).head(lens);
    const Eigen::MatrixXd covariance = solution.covariance.topLeftCorner(lens, lens);
    // Parameters of very different units.
    const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    nees += geometry::squaredMahalanobis(scale.asDiagonal() * error,
                                         scale.asDiagonal() * covariance * scale.asDiagonal());
    squares += error.cwiseAbs2();
    variances += covariance.diagonal();
    pixel_variance += solution.pixel_stddev * solution.pixel_stddev;
    EXPECT_TRUE(solution.covariance.bottomRows(9 - lens).isZero(0.0));
  }
  const Eigen::VectorXd bound = cramerRaoBound(camera, poses, exact, lens, kSigma).diagonal();
  return {(squares.cwiseQuotient(bound) / count).cwiseSqrt(),
          (variances.cwiseQuotient(bound) / count).cwiseSqrt(), nees / count / lens,
          std::sqrt(pixel_variance / count)};
}

std::string refusal(const Samples& samples, const SolverOptions& options = SolverOptions()) {
  return refusalOf([&] { solveIntrinsics(samples, options); });
}

TEST(SolveIntrinsics, ExactPixelsGiveTheExactCamera) {
  geometry::Intrinsics camera = paperCamera();
  camera.distortion = {-0.08, 0.05, 0.001, -0.002, 0.03};
  SolverOptions options;
  options.model = LensModel::kFull;
  const Samples samples = simulatedSamples(camera, 20, 0.0, 1);
  const IntrinsicsSolution solution = solveIntrinsics(samples, options);
  // OpenCV holds pixels as float: 6e-5 px.
  EXPECT_LT(solution.reprojection_error, 2e-4);
  const Vector9d error = parameters(solution.intrinsics) - parameters(camera);
  EXPECT_LT(error.head(4).norm(), 0.02) << error.transpose();
  EXPECT_LT(error.tail(5).norm(), 0.01) << error.transpose();
  EXPECT_EQ(solution.camera_from_board.size(), 20u);
  for (std::size_t view = 0; view < 20; ++view) {
    const auto& pixel = samples.views[view].pixels[5];
    if (pixel) {
      EXPECT_LT(
          (projected(solution.intrinsics, solution.camera_from_board[view], 5) - *pixel).norm(),
          1e-3);
    }
  }
}

TEST(SolveIntrinsics, SaysWhereTheViewsFitBadly) {
  const auto summary = [](double noise) {
    return solveIntrinsics(simulatedSamples(paperCamera(), 16, noise, 1), SolverOptions()).summary;
  };
  EXPECT_EQ(summary(0.5).find("that is much"), std::string::npos) << summary(0.5);
  EXPECT_SAYS(summary(1.5), "; that is much: check that the board is flat");
}

TEST(ExtensiveSolveIntrinsics, TwelveViewsReachTheStatedBound) {
  const geometry::Intrinsics camera = paperCamera();
  SolverOptions options;
  options.model = LensModel::kK1;

  // One set of poses, so that the bound is one; other noise in each run.
  std::mt19937 random(12);
  std::vector<Eigen::Isometry3d> poses;
  Samples exact;
  while (poses.size() < 12) {
    const Eigen::Isometry3d pose = randomPose(random);
    const BoardView view = simulatedView(camera, pose, 0.0, random);
    if (view.count() < 12)
      continue;
    poses.push_back(pose);
    exact.views.push_back(view);
  }
  const Runs runs = solveOften(60, camera, poses, exact, options, 5, random);
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(runs.errors(k), 1.0, 0.3) << k;  // 60 runs: 9 % standard deviation
    EXPECT_NEAR(runs.stated(k), 1.0, 0.05) << k;
  }
  EXPECT_NEAR(runs.nees, 1.0, 0.25);  // 60 runs: 8 %
  EXPECT_NEAR(runs.pixel_stddev, kSigma, 0.01);
}

TEST(SolveIntrinsics, ChoosesTheLensModelThatTheDataAskFor) {
  geometry::Intrinsics straight = paperCamera();
  straight.distortion = {};
  geometry::Intrinsics bent = paperCamera();
  bent.distortion = {-0.4, 0.25, 0.0, 0.0, 0.0};
  bent.fx = bent.fy = 900.0;
  int right = 0;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const IntrinsicsSolution none =
        solveIntrinsics(simulatedSamples(straight, 16, 0.5, seed), SolverOptions());
    right += none.model == LensModel::kNoDistortion ? 1 : 0;
    const IntrinsicsSolution one =
        solveIntrinsics(simulatedSamples(paperCamera(), 16, 0.2, seed), SolverOptions());
    right += one.model == LensModel::kK1 ? 1 : 0;
    const IntrinsicsSolution two =
        solveIntrinsics(simulatedSamples(bent, 16, 0.2, seed), SolverOptions());
    right += two.model == LensModel::kK1K2 ? 1 : 0;
  }
  EXPECT_GE(right, 8);
}

/// Views of a camera behind a wide lens.
Samples wideSamples(const geometry::Intrinsics& camera) {
  std::mt19937 random(2);
  Samples samples;
  while (samples.views.size() < 20) {
    Eigen::Isometry3d pose = randomPose(random);
    pose.translation() *= 0.6;
    const BoardView view = simulatedView(camera, pose, 0.5, random);
    if (view.count() == 16)
      samples.views.push_back(view);
  }
  return samples;
}

TEST(SolveIntrinsics, FindsTheShortFocalLengthOfALensInFront) {
  geometry::Intrinsics wide = paperCamera();
  wide.fx = wide.fy = 420.0;
  wide.distortion = {-0.03, 0.0, 0.0, 0.0, 0.0};
  const IntrinsicsSolution solution = solveIntrinsics(wideSamples(wide), SolverOptions());
  EXPECT_NEAR(solution.intrinsics.fx, 420.0, 4.0 * std::sqrt(solution.covariance(0, 0)))
      << solution.summary;
}

TEST(SolveIntrinsics, RefusesALensWhoseModelFoldsWithinTheImage) {
  geometry::Intrinsics wide = paperCamera();
  wide.fx = wide.fy = 420.0;  // with k1 = -0.08 nothing reaches the corners of the image
  EXPECT_SAYS(refusal(wideSamples(wide)), "does not hold over the whole image");
}

SolverOptions equidistant() {
  SolverOptions options;
  options.model = LensModel::kEquidistant;
  return options;
}

TEST(SolveIntrinsics, ExactPixelsGiveTheExactFisheye) {
  const geometry::Intrinsics camera = fisheye();
  const Samples samples = fisheyeSamples(camera, 20, 0.0, 1);
  const IntrinsicsSolution solution = solveIntrinsics(samples, equidistant());
  EXPECT_EQ(solution.intrinsics.distortion_model, geometry::DistortionModel::kEquidistant);
  EXPECT_LT(solution.reprojection_error, 2e-3);
  // By what it does to pixels: the coefficients stand in for one another.
  for (double u = 0.0; u < 1024.0; u += 93.0) {
    for (double v = 0.0; v < 768.0; v += 69.0) {
      const auto normalized = camera.normalizedFromPixel({u, v});
      ASSERT_TRUE(normalized);
      EXPECT_LT(
          (solution.intrinsics.pixelFromNormalized(*normalized) - Eigen::Vector2d(u, v)).norm(),
          0.2);
    }
  }
  for (std::size_t view = 0; view < samples.views.size(); ++view) {
    if (const auto& pixel = samples.views[view].pixels[5]) {
      EXPECT_LT(
          (projected(solution.intrinsics, solution.camera_from_board[view], 5) - *pixel).norm(),
          0.02);
    }
  }
}

TEST(SolveIntrinsics, AFisheyeReachesTheStatedBound) {
  const geometry::Intrinsics camera = fisheye();
  std::vector<Eigen::Isometry3d> poses;
  const Samples exact = fisheyeSamples(camera, 16, 0.0, 3, &poses);
  std::mt19937 random(13);
  const Runs runs = solveOften(10, camera, poses, exact, equidistant(), 8, random);
  for (int k = 0; k < 8; ++k) {
    EXPECT_NEAR(runs.errors(k), 1.0, 0.7) << k;  // 10 runs: 22 % standard deviation
    EXPECT_NEAR(runs.stated(k), 1.0, 0.1) << k;
  }
  EXPECT_NEAR(runs.nees, 1.0, 0.5);  // 10 runs: 16 %
}

TEST(SolveIntrinsics, AFisheyeIsRefusedForWhatPlumbBobIs) {
  Samples samples = fisheyeSamples(fisheye(), 11, 0.5, 1);
  EXPECT_SAYS(refusal(samples, equidistant()), "11 views of the board, at least 12");
  samples = fisheyeSamples(fisheye(), 14, 0.5, 1);
  samples.board.column_spacing *= 1.1;
  EXPECT_SAYS(refusal(samples, equidistant()), "spacing");
  // And what no plumb_bob model can do says what can.
  samples.board = Board();
  EXPECT_SAYS(refusal(samples), "equidistant");
}

TEST(SolveIntrinsics, RefusesTooFewViewsAndLeds) {
  Samples samples = simulatedSamples(paperCamera(), 11, 0.5, 1);
  EXPECT_SAYS(refusal(samples), "11 views of the board, at least 12");
  samples = simulatedSamples(paperCamera(), 12, 0.5, 1);
  samples.views[4] = BoardView();
  EXPECT_SAYS(refusal(samples), "view 5 shows fewer than 6 LEDs");
  samples = simulatedSamples(paperCamera(), 12, 0.5, 1);
  samples.views[4].pixels[0] = Eigen::Vector2d(std::numeric_limits<double>::quiet_NaN(), 0.0);
  EXPECT_SAYS(refusal(samples), "view 5 has a pixel that is not a number");
  for (int led = 0; led < kBoardLeds; ++led)
    samples.views[4].pixels[static_cast<std::size_t>(led)] =
        Eigen::Vector2d(10.0 * led, 20.0 * led);
  EXPECT_SAYS(refusal(samples), "view 5 shows LEDs of one line only");
}

TEST(SolveIntrinsics, RefusesViewsThatDoNotDiffer) {
  std::mt19937 random(4);
  Samples front;
  Samples one_place;
  Samples one_tilt;
  Eigen::Isometry3d tilted = Eigen::Isometry3d::Identity();
  tilted.linear() = Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX()).toRotationMatrix();
  while (front.views.size() < 14) {
    Eigen::Isometry3d pose = randomPose(random);
    pose.linear().setIdentity();
    const BoardView view = simulatedView(paperCamera(), pose, 0.5, random);
    pose.linear() = tilted.linear();
    const BoardView same = simulatedView(paperCamera(), pose, 0.5, random);
    if (view.count() == 16 && same.count() == 16) {
      front.views.push_back(view);
      one_tilt.views.push_back(same);
    }
    Eigen::Isometry3d centered = randomPose(random);
    centered.translation() =
        Eigen::Vector3d(0.0, 0.0, 0.9) - centered.linear() * Eigen::Vector3d(0.15, 0.15, 0.0);
    one_place.views.push_back(simulatedView(paperCamera(), centered, 0.5, random));
  }
  one_place.views.resize(14);
  EXPECT_SAYS(refusal(front), "from its front or under one tilt");
  EXPECT_SAYS(refusal(one_tilt), "from its front or under one tilt");
  EXPECT_SAYS(refusal(one_place), "at one place");
}

TEST(SolveIntrinsics, RefusesABoardThatIsNotAsStated) {
  const Samples samples = simulatedSamples(paperCamera(), 14, 0.5, 6);
  Samples mirrored = samples;
  Samples exchanged = samples;
  for (std::size_t view = 0; view < samples.views.size(); ++view) {
    for (std::size_t led = 0; led < 16; ++led)
      mirrored.views[view].pixels[led] = samples.views[view].pixels[led / 4 * 4 + 3 - led % 4];
    for (std::size_t led = 0; led < 4; ++led)
      std::swap(exchanged.views[view].pixels[led], exchanged.views[view].pixels[4 + led]);
  }
  EXPECT_SAYS(refusal(mirrored), "mirrored");
  EXPECT_SAYS(refusal(exchanged), "is no 4 x 4 grid");
  Samples stretched = samples;
  stretched.board.column_spacing *= 1.1;
  EXPECT_SAYS(refusal(stretched), "spacing");

  // One LED soldered 3 cm beside its place.
  Board bent;
  std::mt19937 random(9);
  Samples wrong;
  while (wrong.views.size() < 14) {
    const Eigen::Isometry3d pose = randomPose(random);
    BoardView view = simulatedView(paperCamera(), pose, 0.5, random);
    if (view.count() < 16)
      continue;
    const Eigen::Vector3d p = pose * (bent.position(5) + Eigen::Vector3d(0.03, 0.0, 0.0));
    view.pixels[5] = paperCamera().pixelFromNormalized(p.hnormalized());
    wrong.views.push_back(view);
  }
  EXPECT_SAYS(refusal(wrong), "check");
}

}  // namespace
}  // namespace wiimote_tracker::intrinsics
