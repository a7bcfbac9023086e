// The evaluation's sessions of the paper: their random draws, and that they separate good
// calibrations from bad ones.
#include "paper/calibrations.h"
#include "paper/experiment.h"
#include "paper/session.h"

#include "wiimote_tracker_calibration/simulation/wave_bound.h"
#include "wiimote_tracker_calibration/wave/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace wiimote_tracker::monte_carlo {
namespace {

const simulation::Description& paperRig() {
  static const simulation::Description rig =
      simulation::readDescription(SIMULATION_FOLDER "/paper_rig.yaml");
  return rig;
}

PaperSession twoCameras(std::uint32_t seed) {
  return drawPaperSession(paperRig(), {0, 1}, seed);
}

/// Sum of the squared errors of the ten points [m^2].
double squaredError(const PaperSession& session,
                    const geometry::Rig& rig,
                    geometry::TriangulationMethod method) {
  geometry::TriangulationOptions options;
  options.method = method;
  double sum = 0.0;
  for (const StillLed& led : session.points)
    sum += (measure(session, rig, led, options).value().position - led.truth).squaredNorm();
  return sum;
}

/// Least mean of the same for any estimator.
double leastSquaredError(const PaperSession& session,
                         const wave::WaveScene& scene,
                         const wave::SimulatedWave& wave) {
  const double pixel = std::sqrt(scene.pixel * scene.pixel + 1.0 / 12.0);
  const Eigen::MatrixXd covariance =
      wave::waveBound(scene, wave, pixel, {session.points[0].truth}).covariance;
  double sum = 0.0;
  for (const StillLed& led : session.points)
    sum += wave::pointBound(wave.cameras, covariance, led.truth, stillPixelStddev(paperRig()))
               .value()
               .trace();
  return sum;
}

/// The same from the square alone.
double leastOfSquare(const PaperSession& session) {
  wave::SimulatedWave no_wave = session.wave;
  no_wave.views.clear();
  return leastSquaredError(session, session.wave_scene, no_wave);
}

/// Largest ratio of a mean of `count` sums of squares to its expectation by chance (3 standard
/// deviations): a sum of squares of Gaussian errors with covariance S has the variance 2 tr(S^2),
/// which is at most 2 tr(S)^2.
double chance(int count) {
  return 1.0 + 3.0 * std::sqrt(2.0 / count);
}

TEST(PaperSessions, PointsAreThePapersAndPlacedWithinItsErrors) {
  const std::vector<Eigen::Vector3d> points = tenPoints();
  ASSERT_EQ(points.size(), 10U);
  EXPECT_EQ(points[3], Eigen::Vector3d(0.0, 2.5, 0.0));
  EXPECT_EQ(points[6], Eigen::Vector3d(2.5, 2.5, 2.5));
  EXPECT_EQ(points[9], Eigen::Vector3d(1.25, 1.25, 1.5));
  std::mt19937_64 random(1);
  double farthest_on_floor = 0.0;
  double farthest_above = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d floor = placed(points[0], random) - points[0];
    EXPECT_EQ(floor.z(), 0.0);
    farthest_on_floor = std::max(farthest_on_floor, floor.norm());
    farthest_above = std::max(farthest_above, (placed(points[9], random) - points[9]).norm());
  }
  EXPECT_LE(farthest_on_floor, 0.01);
  EXPECT_GT(farthest_on_floor, 0.0099);
  EXPECT_LE(farthest_above, 0.03);
  EXPECT_GT(farthest_above, 0.0297);
}

TEST(PaperSessions, EqualSeedsGiveEqualSessions) {
  const PaperSession a = twoCameras(7);
  const PaperSession b = twoCameras(7);
  const PaperSession c = twoCameras(8);
  EXPECT_EQ(a.wave.cameras[1].intrinsics.fx, b.wave.cameras[1].intrinsics.fx);
  EXPECT_EQ(a.points[9].pixels, b.points[9].pixels);
  EXPECT_EQ(a.wand.recording.cameras[0].frames.back().stamp,
            b.wand.recording.cameras[0].frames.back().stamp);
  EXPECT_NE(a.wave.cameras[1].intrinsics.fx, c.wave.cameras[1].intrinsics.fx);
  // The wand is waved in front of the same cameras, and both see all ten points.
  EXPECT_EQ(a.wave.cameras[1].intrinsics.fx, a.wand.cameras[1].intrinsics.fx);
  ASSERT_EQ(a.points.size(), 10U);
  for (const StillLed& led : a.points) {
    ASSERT_EQ(led.pixels.size(), 2U);
    for (const auto& pixel : led.pixels)
      EXPECT_TRUE(pixel.has_value());
  }
}

// Rays from the image centre start (535.0, 401.7) - (512, 384) px off the poses; 14 rounds leave
// 0.75^14 of that, plus the other errors.
TEST(PaperSessions, TheCorrectionRepairsRaysFromTheImageCentreOfTwoCameras) {
  const auto mean_closest = geometry::TriangulationMethod::kMeanClosest;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const PaperSession session = twoCameras(seed);
    const auto error_of = [&](PaperCase which, geometry::RayModel model) {
      return std::sqrt(
          squaredError(session, solvePaperCase(session, which, model).rig, mean_closest));
    };
    const double before = error_of(PaperCase::kC1, geometry::RayModel::kImageCenter);
    const double after = error_of(PaperCase::kC3, geometry::RayModel::kImageCenter);
    const double consistent = error_of(PaperCase::kC1, geometry::RayModel::kCalibrated);
    EXPECT_GT(before, 2.0 * after) << "seed " << seed;
    EXPECT_GT(before, 2.0 * consistent) << "seed " << seed;
  }
}

TEST(PaperSessions, TheJointSquareReachesItsBoundAndWorseMethodsDoNot) {
  constexpr int kSessions = 10;
  double joint = 0.0;
  double each_camera_alone = 0.0;
  double image_center = 0.0;
  double least = 0.0;
  for (std::uint32_t seed = 1; seed <= kSessions; ++seed) {
    const PaperSession session = twoCameras(seed);
    least += leastOfSquare(session);
    joint += squaredError(session, solveJointSquare(session),
                          geometry::TriangulationMethod::kMaximumLikelihood);
    each_camera_alone += squaredError(
        session, solvePaperCase(session, PaperCase::kC1, geometry::RayModel::kCalibrated).rig,
        geometry::TriangulationMethod::kMaximumLikelihood);
    image_center += squaredError(
        session, solvePaperCase(session, PaperCase::kC1, geometry::RayModel::kImageCenter).rig,
        geometry::TriangulationMethod::kMeanClosest);
  }
  EXPECT_LT(joint, chance(kSessions) * least);
  EXPECT_GT(joint, least / chance(kSessions));
  EXPECT_GT(each_camera_alone, joint);
  EXPECT_GT(image_center, chance(kSessions) * least);
}

TEST(ExtensivePaperSessions, TheWandReachesABoundThatTheSquareAloneDoesNot) {
  constexpr int kSessions = 3;
  double wand = 0.0;
  double square = 0.0;
  double least = 0.0;
  double least_of_square = 0.0;
  for (std::uint32_t seed = 1; seed <= kSessions; ++seed) {
    const PaperSession session = twoCameras(seed);
    least += leastSquaredError(session, session.wand_scene, session.wand);
    least_of_square += leastOfSquare(session);
    wand += squaredError(session, solveWaved(session.wand),
                         geometry::TriangulationMethod::kMaximumLikelihood);
    square += squaredError(session, solveJointSquare(session),
                           geometry::TriangulationMethod::kMaximumLikelihood);
  }
  EXPECT_LT(wand, chance(kSessions) * least);
  EXPECT_GT(wand, least / chance(kSessions));
  // The best method would miss that limit with the square alone.
  EXPECT_GT(least_of_square, chance(kSessions) * least);
  EXPECT_GT(square, wand);
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo
