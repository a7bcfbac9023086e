#pragma once

#include <wiimote_tracker_msgs/GestureEvent.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/ZoneEvent.h>

#include <deque>
#include <string>
#include <vector>

namespace wiimote_tracker::panel {

/// The LEDs and bodies of now, and the latest events. Times are of one steady clock [s].
class TracksView {
 public:
  static constexpr double kStaleAfter = 0.5;     ///< Without a newer message nothing is there [s].
  static constexpr std::size_t kMostEvents = 5;  ///< That are kept.

  /// An LED or a body.
  struct Row {
    std::string name;
    std::string state;    ///< In words.
    double x, y, z;       ///< [m]
    double stddev;        ///< Root of the position covariance's trace [m]; NaN: unknown.
    double speed;         ///< [m/s]; NaN: unknown.
    std::string seen_by;  ///< Cameras of an LED, LEDs of a body: "3 of 4".
  };

  void onPoints(const wiimote_tracker_msgs::TrackedPointArray& message, double now);
  void onBodies(const wiimote_tracker_msgs::TrackedBodyArray& message, double now);
  void onGesture(const wiimote_tracker_msgs::GestureEvent& event);
  void onZone(const wiimote_tracker_msgs::ZoneEvent& event);

  std::vector<Row> leds(double now) const;
  std::vector<Row> bodies(double now) const;

  /// What is tracked and how often, in one sentence.
  std::string summary(double now) const;

  /// Gestures and zones, the newest first, one sentence each.
  const std::deque<std::string>& events() const { return events_; }

 private:
  struct Count {
    double time;           // [s]
    std::uint32_t number;  // of the message
  };

  void addEvent(const std::string& text);

  wiimote_tracker_msgs::TrackedPointArray points_;
  wiimote_tracker_msgs::TrackedBodyArray bodies_;
  double points_at_ = -kStaleAfter, bodies_at_ = -kStaleAfter;
  std::deque<Count> counts_;
  std::deque<std::string> events_;
};

}  // namespace wiimote_tracker::panel
