#include "led_publishers.h"

#include "point_message.h"

#include <algorithm>
#include <iterator>

namespace wiimote_tracker {

using wiimote_tracker_msgs::TrackedPoint;

LedPublishers::LedPublishers(const ros::NodeHandle& nh,
                             const std::vector<std::string>& labels,
                             bool publish_predicted)
    : nh_(nh), listed_(labels.begin(), labels.end()), publish_predicted_(publish_predicted) {
  for (const std::string& label : listed_)
    publisherOf(label);
}

void LedPublishers::publish(const wiimote_tracker_msgs::TrackedPointArray& points) {
  transforms_.clear();
  for (const TrackedPoint& point : points.points) {
    if (!isPosition(point, publish_predicted_))
      continue;
    publisherOf(point.label).publish(pointStamped(points, point));
    transforms_.push_back(transform(points, point));
  }
  if (!transforms_.empty())
    broadcaster_.sendTransform(transforms_);
  if (publishers_.size() > listed_.size())
    dropUnused(points);
}

/// Topics of LEDs that are lost, or have got a listed label.
void LedPublishers::dropUnused(const wiimote_tracker_msgs::TrackedPointArray& points) {
  for (auto publisher = publishers_.begin(); publisher != publishers_.end();) {
    const std::string& label = publisher->first;
    const bool is_used =
        listed_.count(label) > 0 ||
        std::any_of(points.points.begin(), points.points.end(), [&](const TrackedPoint& point) {
          return point.label == label && point.state != TrackedPoint::LOST;
        });
    publisher = is_used ? std::next(publisher) : publishers_.erase(publisher);
  }
}

ros::Publisher& LedPublishers::publisherOf(const std::string& label) {
  const auto found = publishers_.find(label);
  if (found != publishers_.end())
    return found->second;
  return publishers_[label] = nh_.advertise<geometry_msgs::PointStamped>(label + "/point", 100);
}

}  // namespace wiimote_tracker
