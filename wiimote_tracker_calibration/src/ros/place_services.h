#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_PLACE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_PLACE_SERVICES_H

#include "wiimote_tracker_calibration/capture/corner_capture.h"
#include "wiimote_tracker_calibration/place/known_places.h"
#include "wiimote_tracker_calibration/place/measure_place.h"

#include "node_context.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/AddKnownPlace.h>
#include <wiimote_tracker_msgs/CheckPlace.h>
#include <wiimote_tracker_msgs/FitRemap.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A still LED on a known place: check, and known_places/add, undo, clear, fit.
class PlaceServices {
 public:
  explicit PlaceServices(NodeContext* context);

 private:
  bool check(wiimote_tracker_msgs::CheckPlace::Request& request,
             wiimote_tracker_msgs::CheckPlace::Response& response);
  bool add(wiimote_tracker_msgs::AddKnownPlace::Request& request,
           wiimote_tracker_msgs::AddKnownPlace::Response& response);
  bool undo(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool clear(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool fit(wiimote_tracker_msgs::FitRemap::Request& request,
           wiimote_tracker_msgs::FitRemap::Response& response);

  /// What the LED's place was found to be, with the rig of that time.
  struct Outcome {
    bool begun = false;
    workflow::Reply reply;
    std::optional<place::MeasuredPlace> place;
    geometry::Rig rig;
  };
  /// Begins to measure and waits until the LED has lain still; finish() is to follow.
  /// @param duration [s]; 0: as the parameter says.
  Outcome measure(double duration, Lock* lock);
  /// Ends the step, if it was begun, and shows the reply.
  void finish(const Outcome& outcome, const Lock& lock);
  /// Places of another calibration are dropped. @returns what to say of that.
  std::string dropPlacesOfOtherRigs(const Lock& lock);

  NodeContext& context_;
  std::optional<capture::CornerCapture> capture_;  // while a place is being measured
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_PLACE_SERVICES_H
