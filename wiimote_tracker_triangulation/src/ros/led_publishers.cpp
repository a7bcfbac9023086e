#include "led_publishers.h"

#include "odometry.h"
#include "point_message.h"

#include <boost/make_shared.hpp>

#include <algorithm>

namespace wiimote_tracker {

using geometry_msgs::PointStamped;
using wiimote_tracker_msgs::TrackedPoint;

LedPublishers::LedPublishers(const ros::NodeHandle& nh,
                             const std::vector<std::string>& labels,
                             const OutputOptions& options)
    : nh_(nh), listed_(labels.begin(), labels.end()), options_(options) {
  for (const std::string& label : listed_)
    advertise(label);
}

void LedPublishers::advertise(const std::string& label) {
  Topics& topics = topics_[label];
  topics.point = nh_.advertise<PointStamped>(label + "/point", 100);
  if (options_.led_odometry)
    topics.odometry = nh_.advertise<nav_msgs::Odometry>(label + "/odometry", 100);
}

void LedPublishers::publish(const wiimote_tracker_msgs::TrackedPointArray& points) {
  transforms_.clear();
  for (const TrackedPoint& point : points.points) {
    if (!isPublished(point, options_.publish_predicted))
      continue;
    if (topics_.count(point.label) == 0)
      advertise(point.label);
    const Topics& topics = topics_[point.label];
    topics.point.publish(boost::make_shared<PointStamped>(pointStamped(points, point)));
    if (options_.led_odometry)
      topics.odometry.publish(boost::make_shared<nav_msgs::Odometry>(odometry(points, point)));
    transforms_.push_back(transform(points, point));
  }
  if (!transforms_.empty())
    broadcaster_.sendTransform(transforms_);
  removeUnused(points);
}

void LedPublishers::removeUnused(const wiimote_tracker_msgs::TrackedPointArray& points) {
  if (topics_.size() == listed_.size())
    return;
  for (auto topics = topics_.begin(); topics != topics_.end();) {
    const std::string& label = topics->first;
    const bool is_used =
        listed_.count(label) > 0 ||
        std::any_of(points.points.begin(), points.points.end(), [&](const TrackedPoint& point) {
          return point.label == label && point.state != TrackedPoint::LOST;
        });
    topics = is_used ? std::next(topics) : topics_.erase(topics);
  }
}

}  // namespace wiimote_tracker
