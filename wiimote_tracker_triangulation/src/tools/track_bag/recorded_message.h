#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RECORDED_MESSAGE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RECORDED_MESSAGE_H

#include "error.h"
#include "message_bytes.h"

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/message_instance.h>

#include <cstdint>
#include <memory>
#include <utility>

namespace wiimote_tracker {

/// (rosbag's own way to a message copies its connection's header, with its whole definition.)
inline MessageBytes bytesOf(const rosbag::MessageInstance& recorded) {
  struct Stream {
    std::uint8_t* advance(std::uint32_t size) {
      bytes.resize(size);
      return bytes.data();
    }
    MessageBytes bytes;
  } stream;
  recorded.write(stream);
  return std::move(stream.bytes);
}

/// Whether it is of the type. @throws BagError: it is, but as another version of these packages
/// knew it.
template <typename Message>
bool isA(const rosbag::MessageInstance& recorded) {
  if (recorded.getDataType() != ros::message_traits::datatype<Message>())
    return false;
  if (recorded.getMD5Sum() != ros::message_traits::md5sum<Message>())
    throw BagError(recorded.getTopic() + " was recorded with another version of " +
                   recorded.getDataType() + ": convert the bag with rosbag fix");
  return true;
}

template <typename Message>
std::shared_ptr<const Message> messageOf(const MessageBytes& bytes) {
  const auto message = std::make_shared<Message>();
  // The stream promises more than a constant array allows, but is only read from.
  ros::serialization::IStream stream(const_cast<std::uint8_t*>(bytes.data()),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, *message);
  return message;
}

/// The recorded message if it is of the type, otherwise null. @throws BagError as isA().
template <typename Message>
std::shared_ptr<const Message> read(const rosbag::MessageInstance& recorded) {
  return isA<Message>(recorded) ? messageOf<Message>(bytesOf(recorded)) : nullptr;
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RECORDED_MESSAGE_H
