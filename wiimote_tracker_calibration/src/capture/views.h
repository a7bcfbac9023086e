#pragma once

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::capture {

/// The LED in one camera's image.
struct Spot {
  double time;            ///< [s]
  Eigen::Vector2d pixel;  ///< NaN: the LED is not told from other lights.
};

/// Appends the spot of an image, if it has exactly one and is later than those before.
void append(double time, const Image& image, std::vector<Spot>* spots);

/// The LED as one camera sees it at some time.
struct View {
  std::size_t camera;        ///< As the rig counts them.
  Eigen::Vector2d pixel;     ///< [px]
  Eigen::Vector2d velocity;  ///< [px/s]; NaN: unknown. locate() does not need it.
};

/// Interpolated linearly between two images. @param spots of the camera, in the order of their
/// times.
/// @returns nothing where the LED is not seen before and after, kLongestGap apart at most, or where
/// these are two lights (kLongestJump).
std::optional<View> viewAt(std::size_t camera, const std::vector<Spot>& spots, double time);

/// A place that views agree on.
struct Located {
  geometry::TriangulatedPoint point;  ///< Its covariance is for pixel errors of 1 px.
  std::vector<View> views;            ///< That agree.
};

/// If not all views agree, leaves out the one without which the others agree best: it shows another
/// light. @param cameras of the rig. @param gate largest root mean square of the residuals [px].
/// @param least so many views must agree [>= 2].
/// @returns nothing where too few agree.
std::optional<Located> locate(const std::vector<geometry::Camera>& cameras,
                              const std::vector<View>& views,
                              double gate,
                              std::size_t least);

}  // namespace wiimote_tracker::capture
