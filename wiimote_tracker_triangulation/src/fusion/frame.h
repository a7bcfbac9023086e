#ifndef WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_H
#define WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_H

#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::fusion {

constexpr int kNoSpot = -1;

/// A spot of an image, and the same LED's spot in the image before.
struct FrameSpot : tracking::Spot {
  int before = kNoSpot;                                ///< Index in the image before.
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< Since then [px/s]; 0 with kNoSpot.
};

/// One image of a camera.
struct Frame {
  double time = 0.0;     ///< Of the exposure [s].
  double arrival = 0.0;  ///< When it reached the computer [s].
  bool is_full = false;  ///< As many spots as the camera can report.
  std::vector<FrameSpot> spots;
  std::vector<Eigen::Vector2d> masked;  ///< Pixels of spots that are ignored.
};

/// Fills in `before` and `velocity` of an image's spots: the assignment to the spots before, each
/// predicted with its velocity, with the least sum of squared distances. The gate is
/// `maximum_speed` [px/s]. A changed slot costs a little. Exact for up to 16 spots each; those
/// beyond are not followed.
void followSpots(const Frame& before, double maximum_speed, Frame* frame);

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_FUSION_FRAME_H
