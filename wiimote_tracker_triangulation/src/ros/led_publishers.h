#pragma once

#include "tracker/parameters.h"
#include "tracker/point_message.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <chrono>
#include <future>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes each LED by itself: its point on <label>/point, the transform world -> label, and,
/// where asked, <label>/odometry. The topics of listed labels exist from the start, those of other
/// LEDs from their first point until they are lost or get a listed label. Those are advertised in
/// another thread, one LED after the other: while there is no ROS master, advertising waits for it.
class LedPublishers {
  using PointStamped = geometry_msgs::PointStamped;
  using TrackedPoint = wiimote_tracker_msgs::TrackedPoint;

 public:
  LedPublishers(const ros::NodeHandle& nh,
                const std::vector<std::string>& labels,
                const OutputOptions& options)
      : nh_(nh), listed_(labels.begin(), labels.end()), options_(options) {
    for (const std::string& label : listed_)
      topics_[label] = advertise(nh_, label, options_.led_odometry);
  }

  void publish(const wiimote_tracker_msgs::TrackedPointArray& points) {
    if (advertising_.valid() &&
        advertising_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      topics_[advertising_label_] = advertising_.get();
    transforms_.clear();
    for (const TrackedPoint& point : points.points) {
      if (!isPublished(point, options_.publish_predicted))
        continue;
      if (const Topics* topics = topicsOf(point.label)) {
        topics->point.publish(boost::make_shared<PointStamped>(pointStamped(points, point)));
        if (options_.led_odometry)
          topics->odometry.publish(boost::make_shared<nav_msgs::Odometry>(odometry(points, point)));
      }
      transforms_.push_back(transform(points, point));
    }
    if (!transforms_.empty())
      broadcaster_.sendTransform(transforms_);
    removeUnused(points);
  }

 private:
  struct Topics {
    ros::Publisher point;
    ros::Publisher odometry;  // none: not asked for
  };

  static Topics advertise(ros::NodeHandle nh, const std::string& label, bool with_odometry) {
    Topics topics;
    topics.point = nh.advertise<PointStamped>(label + "/point", 100);
    if (with_odometry)
      topics.odometry = nh.advertise<nav_msgs::Odometry>(label + "/odometry", 100);
    return topics;
  }

  /// Null until they are advertised.
  const Topics* topicsOf(const std::string& label) {
    const auto found = topics_.find(label);
    if (found != topics_.end())
      return &found->second;
    if (!advertising_.valid()) {
      advertising_label_ = label;
      advertising_ = std::async(std::launch::async, advertise, nh_, label, options_.led_odometry);
    }
    return nullptr;
  }

  void removeUnused(const wiimote_tracker_msgs::TrackedPointArray& points) {
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

  ros::NodeHandle nh_;
  std::set<std::string> listed_;
  OutputOptions options_;
  std::map<std::string, Topics> topics_;  // by label
  std::string advertising_label_;
  std::future<Topics> advertising_;  // invalid: none are being advertised
  tf2_ros::TransformBroadcaster broadcaster_;
  std::vector<geometry_msgs::TransformStamped> transforms_;  // reused
};

}  // namespace wiimote_tracker
