#include "earlier_results.h"

#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <vector>

namespace wiimote_tracker {
namespace {

MessageBytes serialized(const tf2_msgs::TFMessage& message) {
  MessageBytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

}  // namespace

EarlierResults::EarlierResults(const Topics& topics,
                               const std::set<std::string>& labels,
                               const std::set<std::string>& bodies)
    : topics_{topics.points(), topics.triggeredPoints(), topics.zoneEvents(), topics.bodies(),
              topics.markers()},
      frames_(labels) {
  for (const std::string& label : labels)
    topics_.insert(topics.point(label));
  for (const std::string& body : bodies)
    topics_.insert(topics.pose(body));
  frames_.insert(bodies.begin(), bodies.end());
}

std::optional<MessageBytes> EarlierResults::rest(const rosbag::MessageInstance& message) const {
  const std::string& topic = message.getTopic();
  if (topics_.count(topic) > 0)
    return std::nullopt;
  MessageBytes bytes = bytesOf(message);
  if (topic != Topics::transforms() ||
      message.getMD5Sum() != ros::message_traits::md5sum<tf2_msgs::TFMessage>())
    return bytes;
  // Others send transforms on that topic too, perhaps in the same message.
  tf2_msgs::TFMessage recorded = *messageOf<tf2_msgs::TFMessage>(bytes);
  std::vector<geometry_msgs::TransformStamped>& transforms = recorded.transforms;
  const std::size_t count = transforms.size();
  transforms.erase(std::remove_if(transforms.begin(), transforms.end(),
                                  [&](const geometry_msgs::TransformStamped& t) {
                                    return frames_.count(t.child_frame_id) > 0;
                                  }),
                   transforms.end());
  if (transforms.size() == count)
    return bytes;
  if (transforms.empty())
    return std::nullopt;
  return serialized(recorded);
}

}  // namespace wiimote_tracker
