#pragma once

#include "motion/kinematic_state.h"
#include "motion/pixel_prediction.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::motion {

/// A spot of the LED in a camera's image.
struct Observation {
  double time;  // [s]
  const geometry::Camera* camera;
  Eigen::Vector2d pixel;
  geometry::PixelNoise noise;
};

/// A time for which the LED's state is wanted, and where it was about then.
struct Place {
  double time;               // [s]
  Eigen::Vector3d position;  // to about 0.1 m; it is only where the filters start
};

/// Fixed-interval smoothing: the LED's state at each place's time, given all observations, also the
/// later ones.
///
/// The two-filter form of Helmick, Blair and Hoffman ("Fixed-interval smoothing for Markovian
/// switching systems", IEEE Trans. Information Theory 41(6), 1995): a MotionFilter runs forwards,
/// another backwards in time, and the states of the same mode are combined (Fraser and Potter
/// 1969). The modes at rest and the random walks are the same backwards, and so is the Singer
/// model, which is stationary and reversible. The rates between the modes are taken as the same,
/// too: an approximation, as by Bayes' theorem those backwards depend on the modes' probabilities.
/// Where an observation does not fit what was before, as after the LED was reacquired elsewhere,
/// smoothing starts anew.
/// @param observations, places in the order of time
/// @returns one state for each place
std::vector<KinematicState> smooth(const MotionOptions& options,
                                   const std::vector<Observation>& observations,
                                   const std::vector<Place>& places);

}  // namespace wiimote_tracker::motion
