#pragma once

#include "../rig_subscription.h"
#include "geometry/file_guard.h"
#include "gesture/recognizer.h"
#include "gesture/segmenter.h"
#include "gesture/spotter.h"
#include "gesture_parameters.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <ros/ros.h>
#include <sensor_msgs/Joy.h>
#include <wiimote_tracker_msgs/ListGestures.h>
#include <wiimote_tracker_msgs/RecordGesture.h>
#include <wiimote_tracker_msgs/RemoveGesture.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Recognises gestures in points, for node and nodelet. All callbacks must come from one thread.
class Gestures {
 public:
  /// @throws ParameterError. geometry::Error: the file of examples is damaged.
  Gestures(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);

 private:
  /// Times of the last press [s], and of the release after it.
  struct ButtonTimes {
    std::optional<double> pressed;
    std::optional<double> released;
  };

  /// One LED that may draw.
  struct Hand {
    Hand(std::uint32_t led, const GestureParameters& parameters, const ButtonTimes& button);
    std::uint32_t id;
    std::string label;
    double last_seen = 0.0;  // [s]
    double on_since = 0.0;   // [s]
    gesture::Segmenter segmenter;
    gesture::Spotter spotter;
  };

  void onRig(const wiimote_tracker_msgs::RigCalibration& message);
  void onPoints(const wiimote_tracker_msgs::TrackedPointArray& message);
  bool isStray(double time);
  void onPoint(const wiimote_tracker_msgs::TrackedPoint& point, double time);
  void onJoy(const sensor_msgs::Joy& message);
  void onGesture(const gesture::Path& path, const Hand& hand);
  void keepExample(const gesture::Path& path, const Hand& hand);
  void publish(std::uint8_t event,
               const gesture::Recognition& recognition,
               const gesture::Path& path,
               const Hand& hand);
  void draw(const std::string& text, const gesture::Path& path, std::uint32_t id);

  void check(const wiimote_tracker_msgs::RecordGesture::Request& request) const;
  bool record(wiimote_tracker_msgs::RecordGesture::Request& request,
              wiimote_tracker_msgs::RecordGesture::Response& response);
  bool remove(wiimote_tracker_msgs::RemoveGesture::Request& request,
              wiimote_tracker_msgs::RemoveGesture::Response& response);
  bool list(wiimote_tracker_msgs::ListGestures::Request& request,
            wiimote_tracker_msgs::ListGestures::Response& response);

  void writeExamples(const gesture::Recognizer& recognizer);

  std::string zoneOf(const gesture::Path& path) const;

  ros::NodeHandle nh_;
  GestureParameters parameters_;
  geometry::FileGuard guard_;  // of the file of examples
  gesture::Recognizer recognizer_;
  std::vector<geometry::Zone> zones_;
  std::map<std::uint32_t, Hand> hands_;  // by the id of the LED
  std::string world_frame_;
  double time_ = 0.0;   // of the newest points [s]
  bool stray_ = false;  // the last points were ignored because of their time
  ButtonTimes button_;
  std::optional<gesture::Example> wanted_;  // to be recorded; its path is still empty

  ros::Publisher events_publisher_;
  ros::Publisher markers_publisher_;
  RigSubscription rig_;
  ros::Subscriber points_subscriber_;
  ros::Subscriber joy_subscriber_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker
