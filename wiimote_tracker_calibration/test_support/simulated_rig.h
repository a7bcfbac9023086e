#pragma once

#include "simulated_square.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace wiimote_tracker {

/// How far off the cameras of a calibrated rig are (standard deviations); each camera by itself
/// and, as large again, all of them together.
struct RigErrors {
  double rotation = 0.0005;      // [rad]
  double position = 0.002;       // [m]
  double focal = 2.0;            // [px]
  double principal_point = 2.0;  // [px]
  double k1 = 0.003;
  double k2 = 0.0;
  double time_offset = 0.0001;  // [s]
};

/// Of a rig whose images fit together to about 0.2 px.
inline RigErrors wellCalibrated() {
  RigErrors errors;
  errors.rotation = 1e-4;
  errors.position = 5e-4;
  errors.focal = 0.5;
  errors.principal_point = 0.1;
  errors.k1 = 1e-3;
  return errors;
}

/// Of a rig whose images fit together to about 0.1 px.
inline RigErrors calibratedByWave() {
  RigErrors errors;
  errors.rotation = 4e-5;
  errors.position = 2e-4;
  errors.focal = 0.2;
  errors.principal_point = 0.05;
  errors.k1 = 5e-4;
  return errors;
}

/// The paper's cameras, or so many like them, known with these errors.
geometry::Rig paperRigWith(const RigErrors& errors, std::size_t cameras = 4);

/// A camera whose parameters differ by `delta` (order and meaning as in RigCalibration.msg).
geometry::RigCamera displaced(geometry::RigCamera camera, const Eigen::VectorXd& delta);

/// The camera after it was turned about any axis [rad].
geometry::RigCamera turned(geometry::RigCamera camera, double angle, square::Random& random);

/// The camera after it was turned about its own axes [rad].
geometry::RigCamera turned(geometry::RigCamera camera, const Eigen::Vector3d& rotation);

/// What an accelerometer with a resolution and noise [m/s^2] reads.
Eigen::Vector3d reading(const Eigen::Vector3d& force,
                        double noise,
                        double step,
                        square::Random& random);

/// True cameras of a rig, drawn from its covariance.
std::vector<geometry::RigCamera> drawTruth(const geometry::Rig& rig, square::Random& random);

}  // namespace wiimote_tracker
