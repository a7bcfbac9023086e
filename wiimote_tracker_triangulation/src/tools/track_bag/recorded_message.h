#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RECORDED_MESSAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RECORDED_MESSAGE_H

#include "error.h"

#include <ros/message_traits.h>
#include <rosbag/message_instance.h>

#include <boost/shared_ptr.hpp>

namespace wiimote_tracker {

/// The recorded message if it is of the type, otherwise null. @throws BagError: it is, but as
/// another version of these packages knew it.
template <typename Message>
boost::shared_ptr<const Message> read(const rosbag::MessageInstance& recorded) {
  if (recorded.getDataType() != ros::message_traits::datatype<Message>())
    return nullptr;
  if (recorded.getMD5Sum() != ros::message_traits::md5sum<Message>())
    throw BagError(recorded.getTopic() + " was recorded with another version of " +
                   recorded.getDataType() + ": convert the bag with rosbag fix");
  return recorded.instantiate<Message>();
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RECORDED_MESSAGE_H
