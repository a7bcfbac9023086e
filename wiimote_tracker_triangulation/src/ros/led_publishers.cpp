#include "led_publishers.h"

#include "point_message.h"

#include <boost/make_shared.hpp>

#include <algorithm>

namespace wiimote_tracker {

using geometry_msgs::PointStamped;
using wiimote_tracker_msgs::TrackedPoint;

LedPublishers::LedPublishers(const ros::NodeHandle& nh,
                             const std::vector<std::string>& labels,
                             bool publish_predicted)
    : nh_(nh), listed_(labels.begin(), labels.end()), publish_predicted_(publish_predicted) {
  for (const std::string& label : listed_)
    advertise(label);
}

void LedPublishers::advertise(const std::string& label) {
  publishers_[label] = nh_.advertise<PointStamped>(label + "/point", 100);
}

void LedPublishers::publish(const wiimote_tracker_msgs::TrackedPointArray& points) {
  transforms_.clear();
  for (const TrackedPoint& point : points.points) {
    if (!isPosition(point, publish_predicted_))
      continue;
    if (publishers_.count(point.label) == 0)
      advertise(point.label);
    publishers_[point.label].publish(boost::make_shared<PointStamped>(pointStamped(points, point)));
    transforms_.push_back(transform(points, point));
  }
  if (!transforms_.empty())
    broadcaster_.sendTransform(transforms_);
  removeUnused(points);
}

void LedPublishers::removeUnused(const wiimote_tracker_msgs::TrackedPointArray& points) {
  if (publishers_.size() == listed_.size())
    return;
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

}  // namespace wiimote_tracker
