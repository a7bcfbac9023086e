#include "continuous/adjustment.h"

#include "adjust/chi_squared.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace wiimote_tracker::continuous {

namespace {

using geometry::firstParameter;
using geometry::kParameters;
using geometry::kPosition;
using geometry::kRotation;

constexpr Eigen::Index kPose = 6;  // Parameters of a pose: rotation, position.

// How far a camera may have turned since the rig was solved, standard deviation per axis: at once,
// with time, at most. It moves by the lever times the angle. These are assumed. The benchmark
// drifts by 0.4 mrad an hour. In its eight hours, chi-squared in isWithinDrift() is at most 4; the
// limit is 51. Where another LED was followed, it was over 1,100.
constexpr double kDriftAtOnce = 0.0001;       // [rad]
constexpr double kDriftRate = 0.0005 / 3600;  // [rad/s]
constexpr double kWidestDrift = 0.002;        // [rad]
constexpr double kLever = 0.1;                // [m]

/// The rig with its covariance widened by turns of the cameras [rad], standard deviation per axis.
geometry::Rig withTurns(geometry::Rig rig, double turn) {
  if (!geometry::hasCovariance(rig))
    return rig;
  const double move = kLever * turn;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    auto variance = rig.covariance.diagonal().segment<kParameters>(firstParameter(i));
    variance.segment<3>(kRotation).array() += turn * turn;
    variance.segment<3>(kPosition).array() += move * move;
  }
  return rig;
}

}  // namespace

double driftUntil(double time, const geometry::Rig& rig) {
  return std::min(kDriftAtOnce + kDriftRate * std::abs(time - rig.solved_at), kWidestDrift);
}

geometry::Rig withDrift(geometry::Rig rig, double time) {
  const double turn = driftUntil(time, rig);
  return withTurns(std::move(rig), turn);
}

bool isWithinDrift(const geometry::Rig& rig, const geometry::Rig& adjusted) {
  const Eigen::MatrixXd all = withTurns(rig, kWidestDrift).covariance;
  const auto cameras = static_cast<Eigen::Index>(rig.cameras.size());
  Eigen::VectorXd change(kPose * cameras);
  Eigen::MatrixXd covariance(kPose * cameras, kPose * cameras);
  for (Eigen::Index i = 0; i < cameras; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const geometry::Camera& from = rig.cameras[index].camera;
    const geometry::Camera& to = adjusted.cameras[index].camera;
    const Eigen::AngleAxisd turn(to.world_from_camera.linear() *
                                 from.world_from_camera.linear().transpose());
    change.segment<kPose>(kPose * i) << turn.angle() * turn.axis(), to.center() - from.center();
    for (Eigen::Index k = 0; k < cameras; ++k) {
      covariance.block<kPose, kPose>(kPose * i, kPose * k) = all.block<kPose, kPose>(
          firstParameter(index), firstParameter(static_cast<std::size_t>(k)));
    }
  }
  return geometry::squaredMahalanobis(change, covariance) <
         adjust::chiSquaredQuantile(static_cast<double>(change.size()), adjust::kThreeNines);
}

}  // namespace wiimote_tracker::continuous
