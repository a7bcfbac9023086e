#ifndef WIIMOTE_TRACKER_DRIVER_ROS_CLOCK_READING_H
#define WIIMOTE_TRACKER_DRIVER_ROS_CLOCK_READING_H

#include <ros/time.h>

namespace wiimote_tracker::driver {

/// The steady clock [s].
double steadyNow();

/// The same instant on the steady clock and on the clock of ROS.
struct ClockReading {
  double steady = 0.0;  ///< [s]
  ros::Time ros;
  double uncertainty = 0.0;  ///< Largest time between the two readings [s].
  bool simulated = false;    ///< ROS time is simulated (use_sim_time).
};

ClockReading readClocks();

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_CLOCK_READING_H
