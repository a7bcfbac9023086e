#pragma once

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::continuous {

/// How far the cameras see places move that rest when one rig replaces another: the farthest [m].
/// Places [m] that fewer than two cameras see do not count.
double movementOf(const geometry::Rig& from,
                  const geometry::Rig& to,
                  const std::vector<Eigen::Vector3d>& places);

/// The rig at a share [0..1] of the way to another: poses and lenses in between, everything else of
/// the other one. Its covariance includes what is left of the way.
geometry::Rig between(const geometry::Rig& from, const geometry::Rig& to, double share);

/// Reaches a rig in small steps, so that points at rest do not jump: an adjustment of all cameras
/// may move them by 2.4 mm at once.
class Approach {
 public:
  static constexpr double kLongestStep = 0.0002;  ///< Of the places [m].
  static constexpr double kPeriod = 30.0;         ///< From one step to the next [s].

  /// @param places where the LED was [m], world.
  Approach(geometry::Rig goal, std::vector<Eigen::Vector3d> places)
      : goal_(std::move(goal)), places_(std::move(places)) {}

  /// @param in_use the rig that is replaced. @param stamp of the newest image [s].
  /// @returns the next rig: one at once, then one each period; the goal is the last.
  std::optional<geometry::Rig> step(const geometry::Rig& in_use, double stamp);

  /// Goes on to another rig, of which the cameras that were knocked are used at once: the others
  /// hold the world.
  /// @returns the next rig.
  geometry::Rig changeGoal(const geometry::Rig& goal,
                           const std::vector<std::string>& knocked,
                           const geometry::Rig& in_use);

  const geometry::Rig& goal() const { return goal_; }
  bool isReached() const { return is_reached_; }

 private:
  geometry::Rig goal_;
  std::vector<Eigen::Vector3d> places_;
  double last_step_ = -std::numeric_limits<double>::infinity();  // [s]
  bool is_reached_ = false;
};

}  // namespace wiimote_tracker::continuous
