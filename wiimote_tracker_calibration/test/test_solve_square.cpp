#include "wiimote_tracker_calibration/square/solve_square.h"

#include "expect_says.h"
#include "refusal_of.h"
#include "simulated_square.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <utility>
#include <vector>

namespace wiimote_tracker::square {
namespace {

std::string refusal(const SquareLayout& layout,
                    const std::vector<CameraSightings>& sightings,
                    const SolveOptions& options = SolveOptions()) {
  return refusalOf([&] { solveSquare(layout, sightings, options); });
}

TEST(Solution, HasNoOffsetsOfCornersBeforeItIsSolved) {
  // In memory that is not zero by chance. Volatile: or the compiler leaves it unset, too.
  std::vector<unsigned char> memory(sizeof(Solution), 0xFF);
  unsigned char* volatile place = memory.data();
  auto* solution = new (place) Solution;
  for (const Eigen::Vector3d& offset : solution->corner_offsets)
    EXPECT_TRUE(offset.isZero(0.0)) << offset.transpose();
  solution->~Solution();
}

/// Four cameras around a 2.5 m square, exact.
class FourCameras : public ::testing::Test {
 protected:
  void SetUp() override {
    Random random(5);
    simulated_ = simulateSquare(paperRig(), layout_, true, noErrors(), false, random);
  }

  SquareLayout layout_ = rectangle(2.5, 2.5);
  SimulatedSquare simulated_;
};

struct Setup {
  Method method;
  bool z_up;
};

class NoiseFree : public ::testing::TestWithParam<Setup> {};

TEST_P(NoiseFree, RandomRigsAreSolvedExactly) {
  Random random(17);
  SolveOptions options;
  options.method = GetParam().method;
  for (int trial = 0; trial < 60; ++trial) {
    SquareLayout layout = rectangle(uniform(random, 0.5, 3.0), uniform(random, 0.5, 3.0));
    layout.led_height = uniform(random, 0.0, 0.3);
    layout.origin = Eigen::Vector2d(uniform(random, -2, 2), uniform(random, -2, 2));
    layout.yaw = uniform(random, -M_PI, M_PI);
    const auto count = static_cast<std::size_t>(2 + trial % 7);
    const auto poses = posesAround(layout, GetParam().z_up, count, random);
    const SimulatedSquare simulated =
        simulateSquare(poses, layout, GetParam().z_up, noErrors(), true, random);
    const Solution solution = solveSquare(layout, simulated.sightings, options);
    ASSERT_EQ(solution.rig.cameras.size(), count);
    EXPECT_EQ(solution.z_up, GetParam().z_up);
    for (std::size_t i = 0; i < count; ++i) {
      const geometry::Camera& camera = solution.rig.cameras[i].camera;
      EXPECT_LT((camera.center() - poses[i].translation()).norm(), 1e-7) << trial;
      EXPECT_LT(rotationBetween(camera.world_from_camera, poses[i]), 1e-8) << trial;
      EXPECT_LT(solution.rig.cameras[i].residual_px, 1e-6);
    }
    EXPECT_NO_THROW(solution.rig.check());
  }
}

INSTANTIATE_TEST_SUITE_P(MethodsAndDirections,
                         NoiseFree,
                         ::testing::Values(Setup{Method::kJoint, true},
                                           Setup{Method::kJoint, false},
                                           Setup{Method::kPerCamera, true},
                                           Setup{Method::kPerCamera, false}));

TEST(Layout, CornersFollowHeightOffsetAndYaw) {
  SquareLayout layout = rectangle(2.0, 1.0);
  layout.led_height = 0.1;
  layout.origin = Eigen::Vector2d(2.0, 0.0);  // the second corner
  layout.yaw = M_PI / 2.0;                    // world x along the square's y
  const Corners up = layout.corners(true);
  EXPECT_LT((up[1] - Eigen::Vector3d(0, 0, 0.1)).norm(), 1e-12);
  EXPECT_LT((up[2] - Eigen::Vector3d(1, 0, 0.1)).norm(), 1e-12);
  EXPECT_LT((up[0] - Eigen::Vector3d(0, 2, 0.1)).norm(), 1e-12);
  EXPECT_LT((layout.corners(false)[2] - Eigen::Vector3d(1, 0, -0.1)).norm(), 1e-12);
}

TEST_F(FourCameras, ClockwiseCornersPutZDownWithOneWarning) {
  // Seen from above: first, fourth, third, second corner of the same square.
  for (CameraSightings& camera : simulated_.sightings)
    std::swap(camera.corners[1], camera.corners[3]);
  const Solution solution = solveSquare(layout_, simulated_.sightings, SolveOptions());
  EXPECT_FALSE(solution.z_up);
  ASSERT_EQ(solution.warnings.size(), 1U);
  EXPECT_SAYS(solution.warnings[0], "counter-clockwise to get z up");
  for (std::size_t i = 0; i < 4; ++i) {
    // Mirror at x = y, and z down: the same places in the other world.
    const Eigen::Vector3d p = simulated_.truth[i].center();
    EXPECT_LT(
        (solution.rig.cameras[i].camera.center() - Eigen::Vector3d(p.y(), p.x(), -p.z())).norm(),
        1e-7);
  }
}

TEST_F(FourCameras, ACameraThatMissesACornerIsLeftOutAndNamed) {
  simulated_.sightings[1].corners[2].reset();
  simulated_.sightings[3].corners = {};
  const Solution solution = solveSquare(layout_, simulated_.sightings, SolveOptions());
  ASSERT_EQ(solution.rig.cameras.size(), 2U);
  EXPECT_EQ(solution.rig.cameras[0].camera.name, "camera_1");
  EXPECT_EQ(solution.rig.cameras[1].camera.name, "camera_3");
  ASSERT_EQ(solution.warnings.size(), 2U);
  EXPECT_SAYS(solution.warnings[0], "camera_2 did not see corner 3");
  EXPECT_SAYS(solution.warnings[1], "camera_4 saw no corner");
}

class ThreeCorners : public ::testing::TestWithParam<Method> {};

TEST_P(ThreeCorners, PlaceACameraThatHasAnAccelerometer) {
  Random random(31);
  SolveOptions options;
  options.method = GetParam();
  int solved = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const SquareLayout layout = rectangle(uniform(random, 1.0, 2.5), uniform(random, 1.0, 2.5));
    const bool z_up = trial % 2 == 0;
    const auto poses = posesAround(layout, z_up, 3, random);
    SimulatedSquare simulated = simulateSquare(poses, layout, z_up, noErrors(), true, random);
    simulated.sightings[1].corners[static_cast<std::size_t>(trial % 4)].reset();
    const Solution solution = solveSquare(layout, simulated.sightings, options);
    const auto warning = std::find_if(
        solution.warnings.begin(), solution.warnings.end(), [](const std::string& text) {
          return text.find("camera_2 saw only three corners") != std::string::npos;
        });
    ASSERT_NE(warning, solution.warnings.end());
    if (solution.rig.cameras.size() == 2) {
      EXPECT_SAYS(*warning, "was left out");
      continue;
    }
    ++solved;
    ASSERT_EQ(solution.rig.cameras.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const geometry::RigCamera& camera = solution.rig.cameras[i];
      EXPECT_EQ(camera.camera.name, simulated.truth[i].name);
      EXPECT_LT((camera.camera.center() - poses[i].translation()).norm(), 1e-6) << trial;
      EXPECT_LT(rotationBetween(camera.camera.world_from_camera, poses[i]), 1e-6) << trial;
      EXPECT_EQ(camera.observations, i == 1 ? 3U : 4U);
    }
    EXPECT_TRUE(solution.rig.covariance.allFinite());
  }
  EXPECT_GT(solved, 30);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         ThreeCorners,
                         ::testing::Values(Method::kJoint, Method::kPerCamera));

TEST(ThreeCornersWithErrors, AreKnownAsWellAsTheirCovarianceSays) {
  Random random(37);
  const SquareLayout layout = rectangle(2.5, 2.0);
  const Uncertainty assumed;
  Uncertainty errors = noErrors();
  errors.pixel = assumed.pixel;
  errors.placement = assumed.placement;
  errors.gravity = assumed.gravity;
  SolveOptions options;
  options.uncertainty.focal = 1e-4;
  options.uncertainty.aspect = 1e-5;
  options.uncertainty.principal_point = 0.01;
  options.uncertainty.shared_principal_point = 0.0;
  options.uncertainty.k1 = 1e-5;
  double sum = 0.0;
  int count = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const auto poses = posesAround(layout, true, 3, random);
    SimulatedSquare simulated = simulateSquare(poses, layout, true, errors, true, random);
    simulated.sightings[2].corners[static_cast<std::size_t>(trial % 4)].reset();
    const geometry::Rig rig = solveSquare(layout, simulated.sightings, options).rig;
    if (rig.cameras.size() < 3)
      continue;
    sum += poseNees(rig, 2, simulated.truth[2]);
    ++count;
  }
  ASSERT_GT(count, 80);
  // Chi-square: the mean of n squares scatters by sqrt(2 / n), 6 % here; four times that.
  EXPECT_NEAR(sum / (6.0 * count), 1.0, 4.0 * std::sqrt(2.0 / (6.0 * count)));
}

TEST_F(FourCameras, ThreeCornersWhosePlaceIsNotClearAreLeftOut) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d up = simulated_.truth[i].world_from_camera.linear().row(2);
    simulated_.sightings[i].gravity = 9.81 * up;
  }
  simulated_.sightings[1].corners[0].reset();
  EXPECT_EQ(solveSquare(layout_, simulated_.sightings, SolveOptions()).rig.cameras.size(), 4U);
  SolveOptions careful;
  careful.branch_odds = 1e300;
  simulated_.sightings = {simulated_.sightings[0], simulated_.sightings[1]};
  const std::string text = refusal(layout_, simulated_.sightings, careful);
  EXPECT_SAYS(text, "camera_2 saw only three corners and was left out");
  EXPECT_SAYS(text, "does not tell which");
}

TEST(WideLens, IsSolvedExactly) {
  Random random(41);
  const SquareLayout layout = rectangle(2.5, 2.0);
  SimulatedSquare simulated;
  geometry::Intrinsics lens;
  lens.distortion_model = geometry::DistortionModel::kEquidistant;
  lens.fx = lens.fy = 600.0;
  lens.distortion = {0.02, -0.01, 0.003, 0.0, 0.0};
  const auto poses = posesAround(layout, true, 3, random);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    geometry::Camera camera;
    camera.name = "camera_" + std::to_string(i + 1);
    camera.intrinsics = lens;
    camera.world_from_camera = poses[i];
    CameraSightings sightings;
    sightings.name = camera.name;
    sightings.intrinsics = lens;
    for (std::size_t c = 0; c < 4; ++c)
      sightings.corners[c] = camera.project(layout.corners(true)[c]).value();
    simulated.sightings.push_back(sightings);
  }
  const Solution solution = solveSquare(layout, simulated.sightings, SolveOptions());
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_LT((solution.rig.cameras[i].camera.center() - poses[i].translation()).norm(), 1e-6);
}

TEST_F(FourCameras, FewerThanTwoCamerasAreRefusedByName) {
  for (std::size_t i = 1; i < 4; ++i)
    simulated_.sightings[i].corners[i].reset();
  const std::string text = refusal(layout_, simulated_.sightings);
  EXPECT_SAYS(text, "at least two cameras");
  EXPECT_SAYS(text, "four, or three with its accelerometer");
  EXPECT_SAYS(text, "camera_2 did not see corner 2");
  EXPECT_SAYS(refusal(layout_, {simulated_.sightings[0]}), "at least two cameras");
}

TEST_F(FourCameras, FewerThanFourCornersAreRefused) {
  for (CameraSightings& camera : simulated_.sightings)
    camera.corners[3].reset();
  EXPECT_SAYS(refusal(layout_, simulated_.sightings), "only 3 of 4 corners");
  EXPECT_SAYS(refusal(layout_, {}), "only 0 of 4 corners");
}

TEST_F(FourCameras, CrossingCornersAreRefused) {
  for (CameraSightings& camera : simulated_.sightings)
    std::swap(camera.corners[2], camera.corners[3]);
  EXPECT_SAYS(refusal(layout_, simulated_.sightings), "out of order");
}

TEST_F(FourCameras, CornersOnALineOrInOnePlaceAreRefused) {
  std::vector<CameraSightings> line = simulated_.sightings;
  for (std::size_t i = 0; i < 4; ++i)
    line[i].corners[2] = simulated_.truth[i].project(Eigen::Vector3d(1.25, 0.0, 0.0)).value();
  EXPECT_SAYS(refusal(layout_, line), "on one line");
  std::vector<CameraSightings> twice = simulated_.sightings;
  for (std::size_t i = 0; i < 4; ++i)
    twice[i].corners[2] = *twice[i].corners[1] + Eigen::Vector2d(0.5, 0.5);
  EXPECT_SAYS(refusal(layout_, twice), "in one place");
}

TEST_F(FourCameras, ACornerInsideTheOthersIsRefused) {
  for (std::size_t i = 0; i < 4; ++i)
    simulated_.sightings[i].corners[2] =
        simulated_.truth[i].project(Eigen::Vector3d(0.6, 0.6, 0.0)).value();
  EXPECT_SAYS(refusal(layout_, simulated_.sightings), "do not look like a square");
}

TEST_F(FourCameras, BadSidesAndHeightsAreRefused) {
  for (const double side : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()}) {
    EXPECT_SAYS(refusal(rectangle(side, 1.0), simulated_.sightings), "first to the second");
    EXPECT_SAYS(refusal(rectangle(1.0, side), simulated_.sightings), "second to the third");
  }
  layout_.led_height = -0.1;
  EXPECT_SAYS(refusal(layout_, simulated_.sightings), "height of the LED");
}

TEST_F(FourCameras, AMirroredImageIsRefusedAndNamed) {
  // Raw pixels whose y axis grows upwards fit a square just as well.
  for (auto& corner : simulated_.sightings[2].corners)
    corner->y() = 767.0 - corner->y();
  const std::string text = refusal(layout_, simulated_.sightings);
  EXPECT_SAYS(text, "clockwise for camera_3");
}

TEST_F(FourCameras, AWorldMirroredInAllCamerasIsRefusedByGravity) {
  for (std::size_t i = 0; i < 4; ++i) {
    CameraSightings& camera = simulated_.sightings[i];
    const Eigen::Vector3d up = simulated_.truth[i].world_from_camera.linear().row(2);
    camera.gravity = 9.81 * up;
    for (auto& corner : camera.corners)
      corner->y() = 767.0 - corner->y();
  }
  EXPECT_SAYS(refusal(layout_, simulated_.sightings), "against its accelerometer");
}

TEST_F(FourCameras, SidesThatAreNotThoseOfTheSquareAreRefused) {
  EXPECT_SAYS(refusal(rectangle(2.5, 2.0), simulated_.sightings), "check the sides");
}

TEST_F(FourCameras, ACornerFarFromItsPlaceIsNamed) {
  for (std::size_t i = 0; i < 4; ++i)
    simulated_.sightings[i].corners[2] =
        simulated_.truth[i].project(Eigen::Vector3d(2.56, 2.56, 0.0)).value();
  const Solution solution = solveSquare(layout_, simulated_.sightings, SolveOptions());
  ASSERT_EQ(solution.warnings.size(), 1U) << solution.rig.verdict;
  EXPECT_SAYS(solution.warnings[0], "the cameras disagree");
  ASSERT_TRUE(solution.suspect);
  EXPECT_EQ(solution.suspect->corner, 2U);
}

TEST_F(FourCameras, IsDeterministic) {
  const auto once = solveSquare(layout_, simulated_.sightings, SolveOptions());
  const auto again = solveSquare(layout_, simulated_.sightings, SolveOptions());
  EXPECT_EQ(once.rig.id(), again.rig.id());
}

/// Else residuals of 0.00 px look like a measurement.
TEST_F(FourCameras, TheVerdictSaysThatFittedCornersMakeResidualsSmall) {
  const std::string fitted =
      "px (0.0 mm) with the corners fitted; points in the box over the square";
  SolveOptions options;
  EXPECT_SAYS(solveSquare(layout_, simulated_.sightings, options).rig.verdict, fitted);
  options.method = Method::kPerCamera;
  EXPECT_EQ(solveSquare(layout_, simulated_.sightings, options).rig.verdict.find(fitted),
            std::string::npos);
}

TEST_F(FourCameras, ResidualsAreInPixelsAndMetres) {
  SolveOptions options;
  options.method = Method::kPerCamera;
  Random random(3);
  for (CameraSightings& camera : simulated_.sightings) {
    for (auto& corner : camera.corners)
      *corner += Eigen::Vector2d(normal(random, 0.5), normal(random, 0.5));
  }
  const Solution solution = solveSquare(layout_, simulated_.sightings, options);
  for (std::size_t i = 0; i < 4; ++i) {
    const geometry::RigCamera& camera = solution.rig.cameras[i];
    double sum = 0.0;
    double distance = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector3d corner = layout_.corners(true)[c];
      sum += (*camera.camera.project(corner) - *simulated_.sightings[i].corners[c]).squaredNorm();
      distance += (corner - camera.camera.center()).norm() / 4.0;
    }
    EXPECT_NEAR(camera.residual_px, std::sqrt(sum / 4.0), 1e-9);
    EXPECT_GT(camera.residual_px, 0.0);
    EXPECT_NEAR(camera.residual_m, camera.residual_px * distance / 1304.3, 1e-6);
    EXPECT_EQ(camera.observations, 4U);
  }
}

}  // namespace
}  // namespace wiimote_tracker::square
