// From the views of the board to points: a rig of which one camera has a wide-angle lens.

#include "board_lenses.h"
#include "simulated_square.h"
#include "square/expected_error.h"
#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <gtest/gtest.h>

#include <cmath>

namespace wiimote_tracker {
namespace {

// Square root of the 99.9 % quantile of chi-squared / degrees of freedom, for three: as few as
// there are when the errors of all points are one and the same.
constexpr double kLargest = 2.33;

/// A lens as uncertain as the board leaves it.
square::Uncertainty small() {
  square::Uncertainty errors = square::noErrors();
  errors.pixel = 0.2;
  errors.placement = 0.002;
  errors.focal = 0.002;
  errors.aspect = 0.001;
  errors.principal_point = 1.5;
  errors.k1 = 0.003;
  return errors;
}

square::SolveOptions optionsFor(const square::Uncertainty& errors) {
  square::SolveOptions options;
  const double gravity = options.uncertainty.gravity;
  options.uncertainty = errors;
  options.uncertainty.gravity = gravity;
  return options;
}

/// The first camera, 3 m nearer than the paper's, with the fisheye instead of its lens.
void giveFisheye(square::SimulatedSquare* square,
                 const square::SquareLayout& layout,
                 square::Random& random) {
  geometry::Camera& camera = square->truth[0];
  camera.intrinsics = intrinsics::fisheye();
  camera.world_from_camera = geometry::lookAt(
      camera.center() - 3.0 * camera.world_from_camera.linear().col(2).cwiseProduct(
                                  Eigen::Vector3d(-1.0, -1.0, 0.0)),
      {1.25, 1.25, 0.8}, Eigen::Vector3d::UnitZ());
  for (std::size_t c = 0; c < 4; ++c)
    square->sightings[0].corners[c] =
        camera.project(layout.corners(true)[c]).value() +
        Eigen::Vector2d(square::normal(random, 0.2), square::normal(random, 0.2));
}

/// RMS distance of points from where the first two cameras of the rig measure them [m].
double measuredError(const square::SimulatedSquare& square,
                     const geometry::Rig& rig,
                     const std::vector<Eigen::Vector3d>& points) {
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) {
    std::vector<geometry::Observation> seen;
    for (std::size_t i = 0; i < 2; ++i)
      seen.push_back({&rig.cameras[i].camera, square.truth[i].project(point).value()});
    const auto measured = geometry::triangulate(seen, geometry::TriangulationOptions());
    EXPECT_TRUE(measured);
    sum += (measured->position - point).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(FisheyeRig, ALensFromTheBoardMeasuresPointsAsWellAsPredicted) {
  intrinsics::SolverOptions lens_options;
  lens_options.model = intrinsics::LensModel::kEquidistant;
  const intrinsics::IntrinsicsSolution lens = intrinsics::solveIntrinsics(
      intrinsics::fisheyeSamples(intrinsics::fisheye(), 16, 0.3, 5), lens_options);

  const square::SquareLayout layout = square::paperSquare();
  const std::vector<Eigen::Vector3d> points = square::boxOver(layout.corners(true), true);
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    square::Random random(seed);
    square::SimulatedSquare square =
        square::simulateSquare(square::paperRig(), layout, true, small(), true, random);
    giveFisheye(&square, layout, random);
    square.sightings[0].intrinsics = lens.intrinsics;
    const geometry::Rig rig =
        square::solveSquare(layout, square.sightings, optionsFor(small())).rig;
    ASSERT_EQ(rig.cameras.size(), 4U);
    EXPECT_EQ(rig.cameras[0].camera.intrinsics.distortion_model,
              geometry::DistortionModel::kEquidistant);
    geometry::Rig pair = rig;
    pair.cameras.resize(2);
    pair.covariance = rig.covariance.topLeftCorner(32, 32);
    std::vector<Eigen::Vector3d> seen;
    for (const Eigen::Vector3d& point : points) {
      if (square.truth[0].sees(point) && square.truth[1].sees(point))
        seen.push_back(point);
    }
    ASSERT_GE(seen.size(), 4U);
    const double expected = square::expectedError(pair, seen);
    EXPECT_LT(expected, 0.03);
    EXPECT_LT(measuredError(square, rig, seen), kLargest * expected) << "seed " << seed;
  }
}

}  // namespace
}  // namespace wiimote_tracker
