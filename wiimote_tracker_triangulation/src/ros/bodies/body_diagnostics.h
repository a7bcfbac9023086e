#pragma once

#include "../tracker/body_parameters.h"
#include "body/constellation.h"
#include "wiimote_tracker_triangulation/ros/steady_updater.h"

#include <ros/node_handle.h>
#include <ros/time.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes on /diagnostics: one status for each body.
class BodyDiagnostics {
  using DiagnosticStatus = diagnostic_msgs::DiagnosticStatus;
  using TrackedBody = wiimote_tracker_msgs::TrackedBody;

 public:
  BodyDiagnostics(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
      : updater_(nh, private_nh) {
    updater_.setHardwareID("none");
  }

  void setBodies(const std::vector<body::Constellation>& bodies) {
    for (const auto& [name, seen] : seen_)
      updater_.removeByName("body " + name);
    seen_.clear();
    for (const body::Constellation& body : bodies) {
      const std::string warning = joined(shapeWarnings({body}), "; ");
      seen_[body.name].leds.resize(body.leds.size());
      updater_.add("body " + body.name, [=](diagnostic_updater::DiagnosticStatusWrapper& status) {
        report(body, warning, status);
      });
    }
  }

  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
    for (const TrackedBody& body : bodies.bodies) {
      Seen& seen = seen_[body.name];
      seen.tracked += body.state == TrackedBody::TRACKED;
      seen.lost += body.state == TrackedBody::LOST;
      seen.last_observed = body.last_observed;
      for (std::size_t i = 0; i < body.leds.size() && i < seen.leds.size(); ++i) {
        seen.leds[i].add(body.leds[i].deviation);
        seen.residual.add(body.leds[i].residual);
      }
    }
    for (auto& [name, seen] : seen_) {
      ++seen.images;
      // Time jumped back, as of a bag that starts over.
      if (seen.last_observed > bodies.header.stamp)
        seen.last_observed = ros::Time();
    }
  }

  /// Publishes when due, if there are bodies.
  void update() {
    if (!seen_.empty())
      updater_.update();
  }

 private:
  /// Root mean square.
  struct Rms {
    double squares = 0.0;
    std::size_t count = 0;

    void add(double value) {
      if (std::isnan(value))
        return;
      squares += value * value;
      ++count;
    }
    /// NaN without values.
    double value() const {
      return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
    }
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
              diagnostic_updater::DiagnosticStatusWrapper& status) {
    Seen& seen = seen_[body.name];
    if (seen.tracked > 0)
      status.summary(DiagnosticStatus::OK, "tracked");
    else if (seen.last_observed.isZero())
      status.summary(DiagnosticStatus::OK, "not seen yet");
    else if (seen.images == 0)
      status.summary(DiagnosticStatus::WARN,
                     "no images come, its topics are silent: see what is said of triangulation");
    else
      status.summaryf(
          DiagnosticStatus::WARN,
          "not seen for %.1f s, its topics are silent: uncover it, or switch on its LEDs",
          std::max(0.0, ros::Time::now().toSec() - seen.last_observed.toSec()));
    if (!warning.empty())
      status.mergeSummary(DiagnosticStatus::WARN, warning);
    status.addf("share of images in which it is tracked [%]", "%.1f",
                100.0 * seen.tracked / seen.images);
    status.add("times lost", seen.lost);
    status.addf("residual [px]", "%.3f", seen.residual.value());
    for (std::size_t i = 0; i < seen.leds.size(); ++i)
      status.addf("deviation of LED " + body.labelOf(i) + " [mm]", "%.2f",
                  1e3 * seen.leds[i].value());
    Seen next;
    next.last_observed = seen.last_observed;
    next.leds.resize(seen.leds.size());
    seen = next;
  }

  std::map<std::string, Seen> seen_;  // by name
  SteadyUpdater updater_;
};

}  // namespace wiimote_tracker
