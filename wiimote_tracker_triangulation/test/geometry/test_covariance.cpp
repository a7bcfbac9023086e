// Whether the covariance is consistent with the errors that noisy pixels cause and with the
// Cramer-Rao bound. The bound uses OpenCV's projection, numerical derivatives and an inverse
// written here, so it shares no code with the estimator.
#include "geometry/random_rigs.h"
#include "opencv_camera.h"
#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <iostream>

namespace wiimote_tracker::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::OpenCvCamera;
using test::Random;

constexpr double kPixelStddev = 0.5;
constexpr int kPlaces = 1000;
constexpr int kDrawsPerPlace = 100;

/// Trace of the inverse of a symmetric 3x3 matrix, by cofactors.
double traceOfInverse(const double m[3][3]) {
  const double c00 = m[1][1] * m[2][2] - m[1][2] * m[2][1];
  const double c11 = m[0][0] * m[2][2] - m[0][2] * m[2][0];
  const double c22 = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const double c01 = m[1][2] * m[2][0] - m[1][0] * m[2][2];
  const double c02 = m[1][0] * m[2][1] - m[1][1] * m[2][0];
  const double determinant = m[0][0] * c00 + m[0][1] * c01 + m[0][2] * c02;
  return (c00 + c11 + c22) / determinant;
}

/// Cramer-Rao bound on the mean squared distance [m^2] of any unbiased estimate of the point:
/// trace of the inverse Fisher information, sum over cameras of J^T J / sigma^2.
double boundAt(const std::vector<OpenCvCamera>& cameras, const Vector3d& point) {
  constexpr double kStep = 1e-4;  // [m]
  double information[3][3] = {};
  for (const OpenCvCamera& camera : cameras) {
    Vector2d slope[3];
    for (int a = 0; a < 3; ++a) {
      const Vector3d step = kStep * Vector3d::Unit(a);
      slope[a] = (camera.project(point + step) - camera.project(point - step)) / (2.0 * kStep);
    }
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b)
        information[a][b] += slope[a].dot(slope[b]) / (kPixelStddev * kPixelStddev);
    }
  }
  return traceOfInverse(information);
}

/// The paper's Fig. 1: cameras 4.5 m outside the vertical edges of a cube of 2.5 m, on its
/// diagonals, 2.0 m high, aimed at the centre; lenses that differ and distort. Beyond four: between
/// them. Fewer: neighbours.
Rig paperRig(Random& random, int cameras) {
  Rig rig;
  const Vector3d center(1.25, 1.25, 1.25);
  for (int i = 0; i < cameras; ++i) {
    const double angle = (i < 4 ? M_PI / 4.0 : 0.0) + i * M_PI / 2.0;
    const double distance = 1.25 * std::sqrt(2.0) + 4.5;
    RigCamera camera;
    camera.camera.name = "wiimote_" + std::to_string(i + 1);
    camera.camera.world_from_camera = lookAt(
        {center.x() + distance * std::cos(angle), center.y() + distance * std::sin(angle), 2.0},
        center, Vector3d::UnitZ());
    camera.camera.intrinsics.fx *= random.uniform(0.97, 1.03);
    camera.camera.intrinsics.fy = camera.camera.intrinsics.fx;
    camera.camera.intrinsics.distortion[0] = random.uniform(-0.02, 0.02);
    rig.cameras.push_back(camera);
  }
  return rig;
}

struct Score {
  double nees = 0.0;              // mean normalised estimation error squared; 3 when consistent
  double rms_over_bound = 0.0;    // 1 when efficient
  double claimed_over_rms = 0.0;  // RMS error by the covariance, over the true one
};

Score score(TriangulationMethod method, unsigned seed, int cameras = 4) {
  Random random(seed);
  const Rig rig = paperRig(random, cameras);
  std::vector<OpenCvCamera> references;
  std::vector<Observation> observations;
  for (const RigCamera& camera : rig.cameras) {
    references.emplace_back(camera.camera);
    observations.push_back({&camera.camera, Vector2d::Zero()});
  }
  TriangulationOptions options;
  options.method = method;
  options.pixel_stddev = kPixelStddev;

  double nees = 0.0;
  double squared_error = 0.0;
  double bound = 0.0;
  double claimed = 0.0;
  for (int place = 0; place < kPlaces; ++place) {
    const Vector3d truth = Vector3d(1.25, 1.25, 1.25) + random.inBox(1.25);
    bound += kDrawsPerPlace * boundAt(references, truth);
    std::vector<Vector2d> exact;
    for (const OpenCvCamera& reference : references)
      exact.push_back(reference.project(truth));
    for (int draw = 0; draw < kDrawsPerPlace; ++draw) {
      for (std::size_t c = 0; c < exact.size(); ++c) {
        const double noise_u = random.gaussian();
        const double noise_v = random.gaussian();
        observations[c].pixel = exact[c] + kPixelStddev * Vector2d(noise_u, noise_v);
      }
      const auto point = triangulate(observations, options);
      if (!point) {
        ADD_FAILURE() << "no point";
        return {};
      }
      const Vector3d error = point->position - truth;
      nees += geometry::squaredMahalanobis(error, point->covariance);
      squared_error += error.squaredNorm();
      claimed += point->covariance.trace();
    }
  }
  constexpr double kCount = kPlaces * kDrawsPerPlace;
  return {nees / kCount, std::sqrt(squared_error / bound), std::sqrt(claimed / squared_error)};
}

/// Expects that the covariance is that of the errors, and these no smaller than the bound.
/// @returns rms_over_bound
double expectConsistent(const std::string& name,
                        TriangulationMethod method,
                        unsigned seed,
                        int cameras = 4) {
  const Score s = score(method, seed, cameras);
  std::cout << name << ", " << cameras << " cameras: NEES " << s.nees
            << ", RMS over Cramer-Rao bound " << s.rms_over_bound << ", claimed over true RMS "
            << s.claimed_over_rms << std::endl;
  EXPECT_NEAR(s.nees, 3.0, 0.04) << cameras;
  EXPECT_NEAR(s.claimed_over_rms, 1.0, 0.01) << cameras;
  EXPECT_GE(s.rms_over_bound, 0.99) << cameras;
  return s.rms_over_bound;
}

TEST(Covariance, MaximumLikelihoodIsConsistentAndReachesTheBound) {
  EXPECT_LE(expectConsistent("maximum likelihood", TriangulationMethod::kMaximumLikelihood, 21),
            1.01);
}

TEST(Covariance, MaximumLikelihoodReachesTheBoundWithAnyNumberOfCameras) {
  for (const int cameras : {2, 3, 8})
    EXPECT_LE(expectConsistent("maximum likelihood", TriangulationMethod::kMaximumLikelihood, 24,
                               cameras),
              1.01)
        << cameras;
}

TEST(Covariance, ReweightedMidpointIsConsistentAndNearTheBound) {
  EXPECT_LE(expectConsistent("reweighted midpoint", TriangulationMethod::kReweightedMidpoint, 25),
            1.01);
}

TEST(Covariance, LeastSquaresIsConsistent) {
  expectConsistent("least squares", TriangulationMethod::kLeastSquares, 22);
}

TEST(ExtensiveCovariance, MeanClosestIsConsistent) {
  expectConsistent("mean of closest points", TriangulationMethod::kMeanClosest, 23);
}

}  // namespace
}  // namespace wiimote_tracker::geometry
