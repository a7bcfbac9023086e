#pragma once

#include "body/constellation.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::body {

/// A point that may be one of a body's LEDs.
struct MeasuredPoint {
  Eigen::Vector3d position;  ///< World [m].
  double stddev = 0.003;     ///< Per coordinate, including the body's flexing [m, > 0].
  bool taken = false;        ///< Belongs to another body.
};

constexpr int kUnseen = -1;

/// Assignment of points to the LEDs of a body.
struct Match {
  std::array<int, kMaximumLeds> point_of_led;  ///< Index of the point, or kUnseen.
  Eigen::Isometry3d world_from_body;

  /// Cost of the best match with another pose minus the cost of this one (in units of chi^2);
  /// infinity when there is none.
  double margin = std::numeric_limits<double>::infinity();
};

/// Minimises chi^2 plus a cost for each unseen LED over all assignments that agree with the
/// distances between LEDs; exact. Nothing when fewer than three LEDs can be assigned.
std::optional<Match> matchPoints(const Constellation& constellation,
                                 const std::vector<MeasuredPoint>& points);

/// Whether all LEDs lie within half the distance to their nearest neighbour.
bool isSamePose(const std::vector<Eigen::Vector3d>& leds,
                const Eigen::Isometry3d& a,
                const Eigen::Isometry3d& b);

}  // namespace wiimote_tracker::body
