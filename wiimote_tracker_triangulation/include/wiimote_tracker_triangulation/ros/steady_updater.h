#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/time.h>

#include <algorithm>

namespace wiimote_tracker {

/// Diagnostics whose period is that of a clock that is never set. The base counts in ROS time:
/// after a jump back, as of a bag that starts over, it says nothing until the earlier time has
/// come, and nothing at all while simulated time stands still.
class SteadyUpdater : public diagnostic_updater::Updater {
 public:
  using Updater::Updater;

  /// Publishes when due. Replaces update() of the base. @returns whether it did.
  bool update() {
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (now < due_)
      return false;
    due_ = now + ros::WallDuration(getPeriod());
    force_update();
    return true;
  }

  /// Puts off the next report for at least `duration` from now: an earlier one would say little.
  void wait(const ros::WallDuration& duration) {
    due_ = std::max(due_, ros::SteadyTime::now() + duration);
  }

 private:
  ros::SteadyTime due_ = ros::SteadyTime::now() + ros::WallDuration(getPeriod());
};

}  // namespace wiimote_tracker
