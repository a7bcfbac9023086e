#include "body_publishers.h"

#include "body_message.h"

#include <boost/make_shared.hpp>

namespace wiimote_tracker {

BodyPublishers::BodyPublishers(const ros::NodeHandle& nh, bool publish_predicted)
    : nh_(nh),
      publish_predicted_(publish_predicted),
      all_(nh_.advertise<wiimote_tracker_msgs::TrackedBodyArray>("bodies", 100)) {}

void BodyPublishers::setBodies(const std::vector<body::Constellation>& bodies) {
  std::map<std::string, ros::Publisher> publishers;
  for (const body::Constellation& body : bodies) {
    const auto old = publishers_.find(body.name);
    publishers[body.name] =
        old != publishers_.end()
            ? old->second
            : nh_.advertise<geometry_msgs::PoseWithCovarianceStamped>(body.name + "/pose", 100);
  }
  publishers_ = std::move(publishers);
}

void BodyPublishers::publish(const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
  all_.publish(bodies);
  transforms_.clear();
  for (const wiimote_tracker_msgs::TrackedBody& body : bodies.bodies) {
    const auto publisher = publishers_.find(body.name);
    if (publisher == publishers_.end() || !isPose(body, publish_predicted_))
      continue;
    publisher->second.publish(
        boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>(poseStamped(bodies, body)));
    transforms_.push_back(transform(bodies, body));
  }
  if (!transforms_.empty())
    broadcaster_.sendTransform(transforms_);
}

}  // namespace wiimote_tracker
