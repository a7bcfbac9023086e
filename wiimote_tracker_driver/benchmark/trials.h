#pragma once

#include <cstdint>
#include <string>
#include <vector>

// The sections of benchmark_driver. Each throws std::runtime_error when it cannot be measured;
// what() says what to do. Load and cost start their own ROS master and fork: call them while this
// process has one thread.
namespace wiimote_tracker {

/// A number with its unit and its name.
struct Result {
  std::string name;  ///< Lower case with underscores.
  double value;
  std::string unit;
};

using Results = std::vector<Result>;

/// Virtual remotes in their own process, at 100 Hz each, and driver nodelets in this process, which
/// subscribes to their blobs as another nodelet would. Measures for `duration` [s]: CPU time of
/// this process, time from the remote's sample to the subscriber's callback, and lost data reports.
Results runLoad(int remotes, double duration);

/// Processor time of driver_node with one virtual remote at 100 Hz, beside a node that does nothing
/// but publish the same message as often. Both run at the same time, without and with a subscriber
/// in turn, `duration` [s] each in all.
Results runCost(double duration);

/// A month or less of one remote in fake time, as fast as possible: data reports through decoder,
/// state machine and stamper. Every hour the connection is lost, the remote loses its mode, or its
/// power is cycled; batteries last for 40 hours. The clocks are those of SoakStamps.
/// @param reports more than the 25 hours after which memory must not grow: 1e7; 2.6e8 are 30 days.
/// @param hour [s]; a short one for tests.
Results runSoak(std::uint64_t reports, double hour = 3600.0);

}  // namespace wiimote_tracker
