#include "led_publishers.h"

#include "point_message.h"
#include "publish_at_once.h"

#include <algorithm>

namespace wiimote_tracker {

using wiimote_tracker_msgs::TrackedPoint;

namespace {

ros::Publisher advertise(ros::NodeHandle nh, const std::string& label) {
  return nh.advertise<geometry_msgs::PointStamped>(label + "/point", 100);
}

}  // namespace

LedPublishers::LedPublishers(const ros::NodeHandle& nh,
                             const std::vector<std::string>& labels,
                             bool publish_predicted)
    : nh_(nh), listed_(labels.begin(), labels.end()), publish_predicted_(publish_predicted) {
  for (const std::string& label : listed_)
    publishers_[label] = advertise(nh, label);
}

bool LedPublishers::publish(const wiimote_tracker_msgs::TrackedPointArray& points) {
  transforms_.clear();
  for (const TrackedPoint& point : points.points) {
    if (!isPosition(point, publish_predicted_))
      continue;
    const auto publisher = publishers_.find(point.label);
    if (publisher != publishers_.end())
      publishAtOnce(publisher->second, pointStamped(points, point));
    else
      waiting_.emplace_back(point.label, pointStamped(points, point));
    transforms_.push_back(transform(points, point));
  }
  if (!transforms_.empty())
    broadcaster_.sendTransform(transforms_);
  findUnused(points);
  return !waiting_.empty() || !unused_.empty();
}

void LedPublishers::findUnused(const wiimote_tracker_msgs::TrackedPointArray& points) {
  unused_.clear();
  if (publishers_.size() == listed_.size())
    return;
  for (const auto& [label, publisher] : publishers_) {
    const bool is_used =
        listed_.count(label) > 0 ||
        std::any_of(points.points.begin(), points.points.end(),
                    [&, &used = label](const TrackedPoint& point) {
                      return point.label == used && point.state != TrackedPoint::LOST;
                    });
    if (!is_used)
      unused_.push_back(label);
  }
}

void LedPublishers::changeTopics() {
  for (const std::string& label : unused_)
    publishers_.erase(label);
  unused_.clear();
  for (const auto& [label, point] : waiting_) {
    if (publishers_.count(label) == 0)
      publishers_[label] = advertise(nh_, label);
    publishers_[label].publish(point);
  }
  waiting_.clear();
}

}  // namespace wiimote_tracker
