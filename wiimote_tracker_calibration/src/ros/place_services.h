#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_PLACE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_PLACE_SERVICES_H

#include "capture/corner_capture.h"
#include "place/known_places.h"
#include "place/measure_place.h"

#include "node_context.h"

#include <wiimote_tracker_msgs/AddKnownPlace.h>
#include <wiimote_tracker_msgs/CheckPlace.h>
#include <wiimote_tracker_msgs/FitRemap.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A still LED on a known place: check, and known_places/add, undo, clear, fit.
class PlaceServices {
 public:
  explicit PlaceServices(NodeContext* context);

 private:
  workflow::Reply check(const wiimote_tracker_msgs::CheckPlace::Request& request,
                        wiimote_tracker_msgs::CheckPlace::Response* response);
  workflow::Reply add(const wiimote_tracker_msgs::AddKnownPlace::Request& request,
                      wiimote_tracker_msgs::AddKnownPlace::Response* response);
  workflow::Reply undo();
  workflow::Reply clear();
  workflow::Reply fit(const wiimote_tracker_msgs::FitRemap::Request& request,
                      wiimote_tracker_msgs::FitRemap::Response* response);

  /// What is done with a measured place and the rig that measured it.
  using Use = std::function<workflow::Reply(const place::MeasuredPlace&, const geometry::Rig&)>;
  /// Waits until the LED has lain still, measures where it is, and passes that on.
  /// @param duration longest wait [s]; 0: the parameter.
  workflow::Reply measure(double duration, Lock* lock, const Use& use);
  /// Captures the LED with all cameras of the rig.
  /// @throws Refusal: it was not still or not seen for long enough, or the job was cancelled.
  capture::CapturedCorner captureStillLed(const geometry::Rig& rig,
                                          const capture::CornerCaptureOptions& options,
                                          Lock* lock);
  /// Drops places that another calibration measured. @returns what to say about that.
  std::string dropPlacesOfOtherRigs(const Lock& lock);

  NodeContext& context_;
  std::optional<capture::CornerCapture> capture_;  // while a place is being measured
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_PLACE_SERVICES_H
