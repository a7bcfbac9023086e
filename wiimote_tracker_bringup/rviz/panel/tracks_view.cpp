#include "tracks_view.h"

#include <wiimote_tracker_msgs/doubtful_label.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace wiimote_tracker::panel {
namespace {

using wiimote_tracker_msgs::BodyLed;
using wiimote_tracker_msgs::GestureEvent;
using wiimote_tracker_msgs::TrackedBody;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::ZoneEvent;

constexpr double kCountWindow = 2.0;  // [s]

/// Of an LED or a body that is not lost.
std::string stateOf(std::uint8_t state) {
  return state == TrackedPoint::TRACKED     ? "tracked"
         : state == TrackedPoint::PREDICTED ? "predicted"
         : state == TrackedPoint::TENTATIVE ? "tentative"
                                            : "unknown";
}

double length(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

void TracksView::onPoints(const wiimote_tracker_msgs::TrackedPointArray& message, double now) {
  if (!counts_.empty() && message.header.seq < counts_.back().number)
    counts_.clear();  // the tracker was started again
  counts_.push_back({now, message.header.seq});
  while (counts_.front().time < now - kCountWindow)
    counts_.pop_front();
  points_ = message;
  points_at_ = now;
}

void TracksView::onBodies(const wiimote_tracker_msgs::TrackedBodyArray& message, double now) {
  bodies_ = message;
  bodies_at_ = now;
}

void TracksView::onGesture(const GestureEvent& event) {
  if (event.event == GestureEvent::RECOGNISED)
    addEvent(event.label + " drew " + event.gesture +
             format(" (fits %.0f %%)", 100.0 * event.score));
  else if (event.event == GestureEvent::RECORDED)
    addEvent(event.label + " recorded " + event.gesture);
  else
    addEvent(event.label + " drew nothing that is known" +
             (event.gesture.empty() ? "" : ", most like " + event.gesture));
}

void TracksView::onZone(const ZoneEvent& event) {
  addEvent(event.label + (event.event == ZoneEvent::ENTERED ? " entered " : " left ") + event.zone);
}

void TracksView::addEvent(const std::string& text) {
  events_.push_front(text);
  if (events_.size() > kMostEvents)
    events_.pop_back();
}

std::vector<TracksView::Row> TracksView::leds(double now) const {
  std::vector<Row> rows;
  if (now - points_at_ >= kStaleAfter)
    return rows;
  for (const TrackedPoint& led : points_.points) {
    if (led.state == TrackedPoint::LOST)
      continue;
    const auto& p = led.position;
    const auto& c = led.position_covariance;
    rows.push_back({shownLabel(led.label, led.label_confidence), stateOf(led.state), p.x, p.y, p.z,
                    std::sqrt(c[0] + c[4] + c[8]),
                    length(led.velocity.x, led.velocity.y, led.velocity.z),
                    std::to_string(led.rays_used) + " of " + std::to_string(led.rays_possible)});
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.name < b.name; });
  return rows;
}

std::vector<TracksView::Row> TracksView::bodies(double now) const {
  std::vector<Row> rows;
  if (now - bodies_at_ >= kStaleAfter)
    return rows;
  for (const TrackedBody& body : bodies_.bodies) {
    if (body.state == TrackedBody::LOST)
      continue;
    const auto& p = body.pose.pose.position;
    const auto& c = body.pose.covariance;
    const auto& v = body.twist.twist.linear;
    const auto seen = std::count_if(body.leds.begin(), body.leds.end(),
                                    [](const BodyLed& led) { return !led.cameras.empty(); });
    rows.push_back({body.name, stateOf(body.state), p.x, p.y, p.z, std::sqrt(c[0] + c[7] + c[14]),
                    length(v.x, v.y, v.z),
                    std::to_string(seen) + " of " + std::to_string(body.leds.size())});
  }
  return rows;
}

std::string TracksView::summary(double now) const {
  if (now - points_at_ >= kStaleAfter)
    return "Nothing is tracked: calibrate, or check that the tracker runs.";
  const std::size_t count = leds(now).size(), body_count = bodies(now).size();
  std::string text = counted(count, "LED");
  if (body_count > 0)
    text = (count > 0 ? text + ", " : "") + std::to_string(body_count) +
           (body_count == 1 ? " body" : " bodies");
  else if (count == 0)
    text = "No LED is seen by two cameras";
  const double duration = counts_.back().time - counts_.front().time;
  if (duration > 0.5 * kCountWindow)
    text += format(", %.0f points/s", (counts_.back().number - counts_.front().number) / duration);
  return text;
}

}  // namespace wiimote_tracker::panel
