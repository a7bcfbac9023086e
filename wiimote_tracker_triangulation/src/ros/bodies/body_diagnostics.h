#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_DIAGNOSTICS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_DIAGNOSTICS_H

#include "body/constellation.h"
#include "wiimote_tracker_triangulation/ros/steady_updater.h"

#include <ros/node_handle.h>
#include <ros/time.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes on /diagnostics: one status for each body.
class BodyDiagnostics {
 public:
  BodyDiagnostics(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);

  void setBodies(const std::vector<body::Constellation>& bodies);
  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies);

  /// Publishes when due, if there are bodies.
  void update() {
    if (!statuses_.empty())
      updater_.update();
  }

 private:
  /// Root mean square.
  struct Rms {
    double squares = 0.0;
    std::size_t count = 0;

    void add(double value);
    double value() const;  ///< NaN without values.
  };
  /// Since the last report.
  struct Seen {
    std::size_t images = 0;
    std::size_t tracked = 0;  // of the images
    std::size_t lost = 0;     // times
    ros::Time last_observed;  // 0: never; kept from report to report
    Rms residual;             // [px]
    std::vector<Rms> leds;    // deviations [m]
  };

  void report(const body::Constellation& body,
              const std::string& warning,
              diagnostic_updater::DiagnosticStatusWrapper& status);

  std::vector<std::string> statuses_;
  std::map<std::string, Seen> seen_;  // by name
  SteadyUpdater updater_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_DIAGNOSTICS_H
