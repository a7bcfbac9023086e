// Solving all that was captured, and the verdict on it. All simulated.
#include "expect_says.h"
#include "refusal_of.h"
#include "simulated_square.h"
#include "wave_trial.h"
#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include "samples/judge.h"
#include "samples/samples_file.h"
#include "samples/solve_samples.h"
#include "square/error.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::samples {
namespace {

/// The same in all bits, as far as anybody reads it.
void expectSame(const Solution& a, const Solution& b) {
  EXPECT_EQ(a.rig.id(), b.rig.id());
  EXPECT_TRUE(a.rig.covariance == b.rig.covariance);
  EXPECT_EQ(a.rig.verdict, b.rig.verdict);
  ASSERT_EQ(a.verdict.cameras.size(), b.verdict.cameras.size());
  for (std::size_t i = 0; i < a.verdict.cameras.size(); ++i) {
    EXPECT_EQ(a.verdict.cameras[i].residual_px, b.verdict.cameras[i].residual_px);
    EXPECT_EQ(a.verdict.cameras[i].position_stddev, b.verdict.cameras[i].position_stddev);
  }
  const std::vector<double>& predicted = a.verdict.predicted_stddev;
  ASSERT_EQ(predicted.size(), b.verdict.predicted_stddev.size());
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const double same = b.verdict.predicted_stddev[i];
    EXPECT_TRUE(predicted[i] == same || (std::isnan(predicted[i]) && std::isnan(same)));
  }
  ASSERT_EQ(a.trace.has_value(), b.trace.has_value());
  if (a.trace) {
    EXPECT_EQ(principal_point::table(*a.trace), principal_point::table(*b.trace));
  }
}

Samples throughFile(const Samples& samples) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("test_samples_" + std::to_string(::getpid()));
  const std::string path = (folder / "samples.yaml").string();
  writeSamplesFile(samples, path);
  const Samples read = readSamplesFile(path);
  std::filesystem::remove_all(folder);
  return read;
}

using square::paperSquare;

/// The paper's four cameras, or the first two, before the square.
square::SimulatedSquare paperScene(std::size_t cameras,
                                   square::Random& random,
                                   const square::Uncertainty& uncertainty = {}) {
  std::vector<Eigen::Isometry3d> poses = square::paperRig();
  poses.resize(cameras);
  return square::simulateSquare(poses, paperSquare(), true, uncertainty, true, random);
}

Samples samplesOf(const square::SquareLayout& layout,
                  const std::vector<square::CameraSightings>& sightings) {
  Samples samples;
  samples.recording.square = layout;
  for (const square::CameraSightings& camera : sightings) {
    samples.recording.cameras.emplace_back();
    samples.recording.cameras.back().sightings = camera;
  }
  return samples;
}

Samples samplesOf(const wave::SimulatedWave& wave) {
  Samples samples;
  samples.recording = wave.recording;
  return samples;
}

SolveOptions optionsOf(const wave::WaveScene& scene) {
  SolveOptions options;
  options.wave = wave::optionsFor(scene);
  options.square.uncertainty = scene.uncertainty;
  return options;
}

wave::WaveScene shortScene() {
  wave::WaveScene scene;
  scene.duration = 6.0;
  scene.rate = 60.0;
  return scene;
}

TEST(SolveSamples, TheSquareAloneIsSolvedByTheChosenMethod) {
  square::Random random(1);
  Samples samples = samplesOf(paperSquare(), paperScene(4, random).sightings);
  samples.world_frame = "hall";
  samples.recording.cameras[2].masks = {{Eigen::Vector2d(100.0, 200.0), 12.0}};
  SolveOptions options;
  for (const square::Method method : {square::Method::kJoint, square::Method::kPerCamera}) {
    options.square.method = method;
    std::vector<square::CameraSightings> sightings;
    for (const wave::CameraRecording& camera : samples.recording.cameras)
      sightings.push_back(camera.sightings);
    geometry::Rig expected = square::solveSquare(paperSquare(), sightings, options.square).rig;
    expected.world_frame = "hall";
    expected.cameras[2].masks = samples.recording.cameras[2].masks;
    const Solution solution = solveSamples(samples, options);
    EXPECT_EQ(solution.rig.id(), expected.id());
    EXPECT_EQ(solution.rig.method, expected.method);
    EXPECT_TRUE(solution.rig.covariance == expected.covariance);
    EXPECT_SAYS(solution.rig.verdict, expected.verdict);
    EXPECT_FALSE(solution.trace);
    expectSame(solution, solveSamples(throughFile(samples), options));
  }
}

TEST(SolveSamples, WhatOnlyTheJointMethodUsesIsRefusedOtherwise) {
  square::Random random(1);
  Samples samples = samplesOf(paperSquare(), paperScene(4, random).sightings);
  samples.recording.square->lengths = {{0, 2, paperSquare().lengthBetween(0, 2), 0.001}};
  SolveOptions options;
  const auto solve = [&] { solveSamples(samples, options); };
  EXPECT_NO_THROW(solve());
  options.square.method = square::Method::kPerCamera;
  EXPECT_SAYS(refusalOf(solve), "need the method joint");
  options.square.method = square::Method::kJoint;
  options.correct_principal_points = true;
  EXPECT_SAYS(refusalOf(solve), "need the method joint");
}

TEST(SolveSamples, GravityIsKeptAlsoWhereItIsNotUsed) {
  square::Random random(2);
  Samples samples = samplesOf(paperSquare(), paperScene(4, random).sightings);
  SolveOptions options;
  options.use_gravity = false;
  const Solution solution = solveSamples(samples, options);
  for (const geometry::RigCamera& camera : solution.rig.cameras)
    EXPECT_TRUE(camera.gravity);
  for (wave::CameraRecording& camera : samples.recording.cameras)
    camera.sightings.gravity.reset();
  EXPECT_EQ(solution.rig.id(), solveSamples(samples, SolveOptions()).rig.id());
}

TEST(SolveSamples, PrincipalPointsAreCorrectedOnRequest) {
  square::Random random(3);
  const Samples samples = samplesOf(paperSquare(), paperScene(4, random).sightings);
  SolveOptions options;
  options.correct_principal_points = true;
  options.correction.rounds = 3;
  options.ray_model = geometry::RayModel::kImageCenter;
  const Solution solution = solveSamples(samples, options);
  ASSERT_TRUE(solution.trace);
  ASSERT_EQ(solution.trace->rounds.size(), 4U);
  EXPECT_LT(solution.trace->rounds.back().origin_error, solution.trace->rounds[0].origin_error);
  EXPECT_EQ(solution.rig.ray_model, geometry::RayModel::kImageCenter);
  EXPECT_EQ(solution.rig.cameras[1].camera.intrinsics.cx,
            solution.trace->rounds.back().principal_points[1].x());
  // Its rays have errors that the covariance knows nothing of.
  for (const double stddev : solution.verdict.predicted_stddev)
    EXPECT_TRUE(std::isnan(stddev));
  EXPECT_SAYS(solution.verdict.text, "the corners are measured");
  expectSame(solution, solveSamples(throughFile(samples), options));
}

TEST(SolveSamples, CamerasThatSawLittleOfTheSquareComeFromTheWave) {
  const wave::WaveScene scene = shortScene();
  wave::SimulatedWave wave = wave::simulateWave(scene, 4);
  wave.recording.cameras[1].sightings.corners[2].reset();
  wave.recording.cameras[3].sightings.corners.fill(std::nullopt);
  const Samples samples = samplesOf(wave);
  const SolveOptions options = optionsOf(scene);
  const Solution solution = solveSamples(samples, options);
  EXPECT_EQ(solution.rig.method, "square+wave");
  ASSERT_EQ(solution.rig.cameras.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const CameraVerdict& camera = solution.verdict.cameras[i];
    const double off = (solution.rig.cameras[i].camera.center() - wave.cameras[i].center()).norm();
    EXPECT_LT(off, 4.0 * camera.position_stddev) << i;
    EXPECT_LT(camera.position_stddev, 0.1) << i;
    EXPECT_GT(camera.inlier_share, 0.85) << i;
    EXPECT_LT(camera.time_offset_stddev, 0.0005) << i;
  }
  const Verdict read = verdictOf(solution.rig);  // as of a rig that was loaded
  EXPECT_EQ(read.grade, solution.verdict.grade);
  EXPECT_EQ(read.text, solution.verdict.text);
  EXPECT_EQ(read.cameras[1].position_stddev, solution.verdict.cameras[1].position_stddev);
  expectSame(solution, solveSamples(throughFile(samples), options));
}

TEST(SolveSamples, AWandNeedsNoSquare) {
  wave::WaveScene scene = shortScene();
  scene.square = false;
  scene.length = 0.5;
  const Samples samples = samplesOf(wave::simulateWave(scene, 5));
  const Solution solution = solveSamples(samples, optionsOf(scene));
  EXPECT_EQ(solution.rig.method, "wand");
  EXPECT_TRUE(solution.verdict.predicted_at.empty());
  EXPECT_TRUE(solution.verdict.predicted_stddev.empty());
  EXPECT_EQ(solution.verdict.cameras[0].position_stddev, 0.0);
  EXPECT_SAYS(solution.verdict.text, "points where the LED was waved expected within ");
  EXPECT_SAYS(solution.verdict.text, "to one another");
}

TEST(SolveSamples, PassesOnTheRefusalsOfTheSolvers) {
  square::Random random(6);
  const square::SimulatedSquare scene = paperScene(2, random);
  Samples samples = samplesOf(paperSquare(), scene.sightings);
  const auto refusal = [&] { return refusalOf([&] { solveSamples(samples, SolveOptions()); }); };
  samples.recording.cameras[1].sightings.corners[1].reset();
  samples.recording.cameras[1].sightings.corners[2].reset();
  EXPECT_THROW(solveSamples(samples, SolveOptions()), square::SquareError);
  EXPECT_SAYS(refusal(), "camera_2 did not see");
  samples.recording.square.reset();
  EXPECT_SAYS(refusal(), "nothing was captured");
  samples.recording.cameras[0].frames.resize(200);
  EXPECT_THROW(solveSamples(samples, SolveOptions()), wave::WaveError);
  EXPECT_SAYS(refusal(), "the scale is not determined");
}

TEST(SolveSamples, CanBeCancelled) {
  square::Random random(7);
  const Samples samples = samplesOf(paperSquare(), paperScene(4, random).sightings);
  SolveOptions options;
  struct Stopped {};
  for (const double last : {0.0, 0.1}) {
    const auto stop = [last](const std::string&, double fraction) {
      if (fraction >= last)
        throw Stopped();
    };
    EXPECT_THROW(solveSamples(samples, options, stop), Stopped);
    options.correct_principal_points = true;
  }
}

/// Squared errors at the places of the verdict, of points from perfect pixels, and their predicted
/// squares.
struct Errors {
  double squared = 0.0;
  double predicted = 0.0;
  int count = 0;

  void add(const Solution& solution, const std::vector<geometry::Camera>& truth) {
    for (std::size_t p = 0; p < solution.verdict.predicted_at.size(); ++p) {
      const Eigen::Vector3d& place = solution.verdict.predicted_at[p];
      std::vector<geometry::Observation> observations;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        const auto pixel = truth[i].project(place);
        if (pixel && truth[i].sees(place))
          observations.push_back({&solution.rig.cameras[i].camera, *pixel});
      }
      const auto point = geometry::triangulate(observations, {});
      const double stddev = solution.verdict.predicted_stddev[p];
      if (!point || std::isnan(stddev))
        continue;
      squared += (point->position - place).squaredNorm();
      predicted += stddev * stddev;
      ++count;
    }
  }

  double ratio() const { return std::sqrt(squared / predicted); }
};

TEST(ExtensiveVerdict, PredictsTheErrorsOfASquare) {
  for (const square::Method method : {square::Method::kJoint, square::Method::kPerCamera}) {
    for (const std::size_t cameras : {2U, 4U}) {
      square::Random random(8);
      SolveOptions options;
      options.square.method = method;
      Errors errors;
      int displaced = 0;
      for (int run = 0; run < 60; ++run) {
        const square::SimulatedSquare scene = paperScene(cameras, random);
        const Solution solution = solveSamples(samplesOf(paperSquare(), scene.sightings), options);
        errors.add(solution, scene.truth);
        displaced += solution.verdict.redo_corner ? 1 : 0;
      }
      EXPECT_GT(errors.count, 400);
      EXPECT_GT(errors.ratio(), 0.85) << cameras;
      EXPECT_LT(errors.ratio(), 1.15) << cameras;
      EXPECT_EQ(displaced, 0);
    }
  }
}

TEST(ExtensiveVerdict, PredictsTheErrorsOfAWave) {
  const wave::WaveScene scene = shortScene();
  Errors errors;
  for (std::uint64_t seed = 100; seed < 115; ++seed) {
    const wave::SimulatedWave wave = wave::simulateWave(scene, seed);
    const Solution solution = solveSamples(samplesOf(wave), optionsOf(scene));
    errors.add(solution, wave.cameras);
  }
  EXPECT_GT(errors.ratio(), 0.75);
  EXPECT_LT(errors.ratio(), 1.25);
}

TEST(ExtensiveVerdict, NamesACornerThatWasDisplaced) {
  // Lenses as they come from the board of LEDs: one that may be off by 3 % explains nearly as well
  // what a corner does.
  SolveOptions options;
  options.square.uncertainty.focal = 0.003;
  options.square.uncertainty.aspect = 0.001;
  options.square.uncertainty.principal_point = 2.0;
  options.square.uncertainty.shared_principal_point = 0.0;
  options.square.uncertainty.k1 = 0.005;
  square::Random random(9);
  int named = 0;
  int second = 0;
  const int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    const std::size_t corner = static_cast<std::size_t>(run) % 4;
    square::SimulatedSquare scene = paperScene(4, random, options.square.uncertainty);
    const double angle = square::uniform(random, -M_PI, M_PI);
    const Eigen::Vector3d beside = paperSquare().corners(true)[corner] +
                                   0.05 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    for (std::size_t i = 0; i < 4; ++i)
      scene.sightings[i].corners[corner] = *scene.truth[i].project(beside);
    const std::string name = "corner " + std::to_string(corner + 1);
    try {
      const Solution solution = solveSamples(samplesOf(paperSquare(), scene.sightings), options);
      const Verdict& verdict = solution.verdict;
      if (!verdict.redo_corner)
        continue;
      EXPECT_EQ(verdict.grade, Grade::kRedo);
      EXPECT_SAYS(verdict.text, "redo corner " + std::to_string(*verdict.redo_corner + 1));
      if (verdict.redo_corner == corner) {
        ++named;
      } else {
        // Another explains a little more, and the right one is named beside it.
        ++second;
        EXPECT_SAYS(verdict.text, " or " + std::to_string(corner + 1) + ":");
      }
    } catch (const square::SquareError& error) {
      EXPECT_SAYS(std::string(error.what()), name);
      ++named;
    }
  }
  EXPECT_GE(named, 36);
  EXPECT_LE(second, 2);
}

TEST(Verdict, QuestionsAnImplausibleScale) {
  square::Random random(12);
  const square::SimulatedSquare scene = paperScene(4, random);
  for (const double side : {250.0, 8.2, 0.025}) {  // cm, feet, 100 m for 1 m
    Samples samples = samplesOf(paperSquare(), scene.sightings);
    samples.recording.square->side_x = samples.recording.square->side_y = side;
    SolveOptions options;
    options.square.uncertainty.placement *= side / 2.5;
    const Verdict verdict = solveSamples(samples, options).verdict;
    EXPECT_NE(verdict.grade, Grade::kGood) << side;
    EXPECT_TRUE(verdict.doubts_scale) << side;
    EXPECT_SAYS(verdict.text, "from the LED, but a Wii Remote sees one at 0.3 to 12 m") << side;
  }
}

TEST(ExtensiveVerdict, NamesACornerThatTheWaveContradicts) {
  const wave::WaveScene scene = shortScene();
  wave::SimulatedWave wave = wave::simulateWave(scene, 10);
  const Eigen::Vector3d beside = wave.corners[2] + Eigen::Vector3d(0.05, 0.02, 0.0);
  for (std::size_t i = 0; i < 4; ++i)
    wave.recording.cameras[i].sightings.corners[2] = *wave.cameras[i].project(beside);
  const Solution solution = solveSamples(samplesOf(wave), optionsOf(scene));
  EXPECT_EQ(solution.verdict.grade, Grade::kRedo);
  EXPECT_EQ(solution.verdict.redo_corner, std::size_t{2}) << solution.verdict.text;
  EXPECT_SAYS(solution.verdict.text, "redo corner 3: ");
}

}  // namespace
}  // namespace wiimote_tracker::samples
