#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_INNOVATIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_INNOVATIONS_H

#include <Eigen/Core>

namespace wiimote_tracker::motion {

/// Numbers of the same meaning, one for each of four states that move, or of two that rest.
using Lanes = Eigen::Array4d;
using Pair = Eigen::Array2d;

/// Innovations of several states beside one pixel, whitened: of unit covariance then.
template <typename Numbers>
struct Innovations {
  Eigen::Matrix<double, 2, 3> jacobian;     ///< d pixel / d position [px/m].
  Numbers whiten_uu, whiten_vu, whiten_vv;  ///< Lower triangle that whitens [1/px].
  Numbers u, v;                             ///< [1]
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_INNOVATIONS_H
