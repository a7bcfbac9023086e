#ifndef WIIMOTE_TRACKER_DRIVER_ROS_REALTIME_PRIORITY_H
#define WIIMOTE_TRACKER_DRIVER_ROS_REALTIME_PRIORITY_H

#include <string>

namespace wiimote_tracker::driver {

/// Gives the calling thread real-time priority (SCHED_FIFO, 1..99). @returns an empty string, or
/// one sentence why that failed and what to do.
std::string takeRealtimePriority(int priority);

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_REALTIME_PRIORITY_H
