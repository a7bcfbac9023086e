// Whether predicted errors hold for two kinds of lenses: principal points around the default one,
// and around the image's centre as the paper's corrected ones. To first order, from the covariance.
#include "simulated_square.h"
#include "wave_trial.h"
#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include "samples/solve_samples.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

namespace wiimote_tracker::samples {
namespace {

/// Principal points whose mean is off the default by `offset`.
struct Population {
  double stddev;           ///< Of each camera by itself [px].
  double shared_stddev;    ///< Of the offset that they share [px].
  Eigen::Vector2d offset;  ///< Mean of that [px].

  /// Mean square of the deviations from the default (2 rows per camera) [px^2].
  Eigen::MatrixXd moments(std::size_t cameras) const {
    const auto size = static_cast<Eigen::Index>(2 * cameras);
    Eigen::MatrixXd result = stddev * stddev * Eigen::MatrixXd::Identity(size, size);
    const Eigen::Matrix2d shared =
        shared_stddev * shared_stddev * Eigen::Matrix2d::Identity() + offset * offset.transpose();
    for (Eigen::Index i = 0; i < size; i += 2) {
      for (Eigen::Index j = 0; j < size; j += 2)
        result.block<2, 2>(i, j) += shared;
    }
    return result;
  }
};

/// RMS errors at the verdict's places over the predicted ones. The covariance C is right for
/// lenses as the prior P says; with moments S instead it is C + C P^-1 (S - P) P^-1 C.
double errorsOverPredicted(const Samples& samples,
                           const SolveOptions& options,
                           const Population& truth) {
  const Solution solution = solveSamples(samples, options);
  const geometry::Rig& rig = solution.rig;
  const std::size_t cameras = rig.cameras.size();
  Eigen::MatrixXd by_principal_points(rig.covariance.rows(), 2 * cameras);
  for (std::size_t i = 0; i < cameras; ++i)
    by_principal_points.middleCols<2>(static_cast<Eigen::Index>(2 * i)) =
        rig.covariance.middleCols<2>(geometry::firstParameter(i) + geometry::kIntrinsics + 2);
  const square::Uncertainty& u = options.square.uncertainty;
  const Eigen::MatrixXd prior =
      Population{u.principal_point, u.shared_principal_point, Eigen::Vector2d::Zero()}.moments(
          cameras);
  const Eigen::MatrixXd gain =
      geometry::solveSymmetric(prior, by_principal_points.transpose()).transpose();
  const Eigen::MatrixXd covariance =
      rig.covariance + gain * (truth.moments(cameras) - prior) * gain.transpose();
  double squares = 0.0;
  double predicted = 0.0;
  for (const Eigen::Vector3d& place : solution.verdict.predicted_at) {
    const auto slope = geometry::pointByParameters(rig, place, geometry::camerasSeeing(rig, place));
    if (!slope)
      continue;
    squares += geometry::propagated(*slope, covariance).trace();
    predicted += geometry::propagated(*slope, rig.covariance).trace();
  }
  return std::sqrt(squares / predicted);
}

void expectPredicted(const char* name,
                     const Samples& samples,
                     const SolveOptions& options,
                     double most = 1.1) {
  const Population around_default{15.0, 0.0, {0.0, 0.0}};
  const Population around_centre{5.0, 0.0, {512.0 - 535.0, 384.0 - 401.7}};
  for (const Population& population : {around_default, around_centre}) {
    const double ratio = errorsOverPredicted(samples, options, population);
    std::cout << name << ", " << samples.recording.cameras.size()
              << " cameras, principal points by " << population.stddev << " px: errors / predicted "
              << ratio << '\n';
    EXPECT_GT(ratio, 0.95);
    EXPECT_LT(ratio, most);
  }
}

TEST(ExtensiveLensPopulations, ErrorsOfASquareAreAsPredicted) {
  for (const std::size_t count : {std::size_t{2}, std::size_t{4}}) {
    const square::SquareLayout layout = square::paperSquare();
    auto poses = square::paperRig();
    poses.resize(count);
    square::Random random(8);
    Samples samples;
    samples.recording.square = layout;
    for (const auto& sightings :
         square::simulateSquare(poses, layout, true, square::Uncertainty(), true, random)
             .sightings) {
      samples.recording.cameras.emplace_back();
      samples.recording.cameras.back().sightings = sightings;
    }
    SolveOptions options;
    expectPredicted("joint", samples, options);
    options.square.method = square::Method::kPerCamera;
    expectPredicted("per camera", samples, options, 1.15);
  }
}

TEST(ExtensiveLensPopulations, ErrorsOfAWaveAreAsPredicted) {
  wave::WaveScene scene;
  scene.duration = 8.0;
  scene.rate = 50.0;
  scene.uncertainty = square::Uncertainty();
  for (const std::size_t count : {std::size_t{2}, std::size_t{4}}) {
    scene.camera_count = count;
    Samples samples;
    samples.recording = wave::simulateWave(scene, 106).recording;
    SolveOptions options;
    options.wave = wave::optionsFor(scene);
    expectPredicted("wave", samples, options);
  }
}

}  // namespace
}  // namespace wiimote_tracker::samples
