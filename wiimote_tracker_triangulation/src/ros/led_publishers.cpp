#include "led_publishers.h"

#include "point_message.h"

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
    if (point.state == TrackedPoint::LOST && listed_.count(point.label) == 0)
      publishers_.erase(point.label);
    if (!isPosition(point, publish_predicted_))
      continue;
    publisherOf(point.label).publish(pointStamped(points, point));
    transforms_.push_back(transform(points, point));
  }
  if (!transforms_.empty())
    broadcaster_.sendTransform(transforms_);
}

ros::Publisher& LedPublishers::publisherOf(const std::string& label) {
  const auto found = publishers_.find(label);
  if (found != publishers_.end())
    return found->second;
  return publishers_[label] = nh_.advertise<geometry_msgs::PointStamped>(label + "/point", 100);
}

}  // namespace wiimote_tracker
