#include "earlier_results.h"

#include <ros/serialization.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace wiimote_tracker {
namespace {

using topic_tools::ShapeShifter;

boost::shared_ptr<const ShapeShifter> shapeOf(const tf2_msgs::TFMessage& message) {
  namespace traits = ros::message_traits;
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream output(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(output, message);
  const auto shape = boost::make_shared<ShapeShifter>();
  shape->morph(traits::md5sum(message), traits::datatype(message), traits::definition(message), "");
  ros::serialization::IStream input(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  shape->read(input);
  return shape;
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

boost::shared_ptr<const ShapeShifter> EarlierResults::rest(
    const std::string& topic,
    const boost::shared_ptr<const ShapeShifter>& message) const {
  if (topics_.count(topic) > 0)
    return nullptr;
  if (topic != Topics::transforms() ||
      message->getMD5Sum() != ros::message_traits::md5sum<tf2_msgs::TFMessage>())
    return message;
  // Others send transforms on that topic too, perhaps in the same message.
  const auto recorded = message->instantiate<tf2_msgs::TFMessage>();
  std::vector<geometry_msgs::TransformStamped>& transforms = recorded->transforms;
  const std::size_t count = transforms.size();
  transforms.erase(std::remove_if(transforms.begin(), transforms.end(),
                                  [&](const geometry_msgs::TransformStamped& t) {
                                    return frames_.count(t.child_frame_id) > 0;
                                  }),
                   transforms.end());
  if (transforms.size() == count)
    return message;
  return transforms.empty() ? nullptr : shapeOf(*recorded);
}

}  // namespace wiimote_tracker
