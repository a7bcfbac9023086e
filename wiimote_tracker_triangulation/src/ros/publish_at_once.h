#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PUBLISH_AT_ONCE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PUBLISH_AT_ONCE_H

#include <ros/publisher.h>
#include <boost/make_shared.hpp>

#include <utility>

namespace wiimote_tracker {

/// Subscribers of this process have the message when this returns. Only what is shared goes to them
/// so: of anything else roscpp's own thread makes them a copy, once it has woken up.
template <typename Message>
void publishAtOnce(const ros::Publisher& publisher, Message message) {
  publisher.publish(boost::make_shared<Message>(std::move(message)));
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PUBLISH_AT_ONCE_H
