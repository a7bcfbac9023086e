#include "output.h"

#include "geometry/output_file.h"
#include "ros/tracker/publish_each.h"

#include <tf2_msgs/TFMessage.h>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <cstdio>

namespace wiimote_tracker {

using tf2_msgs::TFMessage;
using wiimote_tracker_msgs::RigCalibration;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

constexpr char kTransforms[] = "/tf";

Output::Output(const std::string& bag,
               const measurements::OutputNames& names,
               const Topics& topics,
               const OutputOptions& options)
    : path_(bag),
      topics_(topics),
      options_(options),
      part_(path_, false),  // that of an earlier run can be computed again
      bag_(std::make_unique<rosbag::Bag>()) {
  try {
    writers_ = measurements::makeWriters(names);
    bag_->open(geometry::partOf(path_), rosbag::bagmode::Write);
  } catch (const rosbag::BagException& e) {
    abandon();
    fail(e.what());
  } catch (...) {
    abandon();
    throw;
  }
}

Output::~Output() {
  abandon();
}

void Output::abandon() {
  // rosbag::Bag's destructor writes the index, and ends the process where that fails, as on a full
  // disk. The bag is not needed: leave it to the end of the process.
  if (bag_.release()) {
    for (const std::unique_ptr<measurements::Writer>& writer : writers_)
      writer->discard();
    part_.discard();
  }
}

void Output::dropRecorded(const std::set<std::string>& labels,
                          const std::set<std::string>& bodies) {
  for (const char* name : {"points", "triggered_points", "zone_events", "bodies", "markers"})
    dropped_topics_.insert(topics_(name));
  for (const std::string& label : labels)
    dropped_topics_.insert({topics_(label + "/point"), topics_(label + "/odometry")});
  for (const std::string& body : bodies)
    dropped_topics_.insert(
        {topics_(body + "/pose"), topics_(body + "/twist"), topics_(body + "/odometry")});
  dropped_frames_ = labels;
  dropped_frames_.insert(bodies.begin(), bodies.end());
}

void Output::copy(const rosbag::MessageInstance& recorded) {
  const std::string& topic = recorded.getTopic();
  if (dropped_topics_.count(topic) > 0)
    return;
  if (topic != kTransforms || !recorded.isType<TFMessage>()) {
    write(topic, recorded.getTime(), recorded, recorded.getConnectionHeader());
    return;
  }
  // The topic carries transforms of other nodes too, perhaps in the same message.
  TFMessage rest;
  for (const geometry_msgs::TransformStamped& t : recorded.instantiate<TFMessage>()->transforms) {
    if (dropped_frames_.count(t.child_frame_id) == 0)
      rest.transforms.push_back(t);
  }
  if (!rest.transforms.empty())
    write(topic, recorded.getTime(), rest, recorded.getConnectionHeader());
}

void Output::writeRig(const RigCalibration& rig, const ros::Time& time) {
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["type"] = ros::message_traits::datatype(rig);
  (*header)["md5sum"] = ros::message_traits::md5sum(rig);
  (*header)["message_definition"] = ros::message_traits::definition(rig);
  (*header)["latching"] = "1";
  (*header)["callerid"] = "/track_bag";
  write(topics_("calibration/rig"), time, rig, header);
}

void Output::onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points,
                      const std::vector<tracking::CameraView>& /*views*/) {
  ++points_;
  write(topics_("points"), now_, *points);
  for (const TrackedPoint& point : points->points)
    ids_.insert(point.id);
  writeTransforms(publishEach(*points, options_, [this](const auto& topic, const auto& message) {
    write(topics_(topic), now_, message);
  }));
  writeMeasurements(*points, false);
}

void Output::onBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
                      const std::vector<bool>& bridged) {
  write(topics_("bodies"), now_, bodies);
  for (const std::unique_ptr<measurements::Writer>& writer : writers_)
    writer->addBodies(bodies);
  writeTransforms(publishEach(
      bodies, bridged, options_,
      [this](const auto& topic, const auto& message) { write(topics_(topic), now_, message); }));
}

void Output::writeTransforms(const std::vector<geometry_msgs::TransformStamped>& transforms) {
  if (transforms.empty())
    return;
  TFMessage message;
  message.transforms = transforms;
  write(kTransforms, now_, message);
}

void Output::onTriggeredPoints(const TrackedPointArray& points) {
  ++triggers_answered_;
  write(topics_("triggered_points"), now_, points);
  writeMeasurements(points, true);
}

void Output::onZoneEvent(const wiimote_tracker_msgs::ZoneEvent& event) {
  ++zone_events_;
  write(topics_("zone_events"), now_, event);
}

void Output::onProblem(const std::string& sentence) {
  std::fprintf(stderr, "track_bag: at %.6f s: %s\n", now_.toSec(), sentence.c_str());
}

void Output::finish() {
  for (const std::unique_ptr<measurements::Writer>& writer : writers_) {
    const std::string sentence = writer->finish();
    if (!sentence.empty())
      std::printf("%s.\n", sentence.c_str());
  }
  try {
    bag_->close();
  } catch (const rosbag::BagException& e) {
    fail(e.what());
  }
  part_.finish();
  bag_.reset();
}

/// `header`: of the connection; without one the topic has one connection for all its messages.
template <typename Message>
void Output::write(const std::string& topic,
                   const ros::Time& time,
                   const Message& message,
                   const boost::shared_ptr<ros::M_string>& header) {
  try {
    bag_->write(topic, std::max(time, ros::TIME_MIN), message, header);
  } catch (const rosbag::BagException& e) {
    fail(e.what());
  }
}

void Output::writeMeasurements(const TrackedPointArray& points, bool triggered) {
  for (const std::unique_ptr<measurements::Writer>& writer : writers_)
    writer->addAll(points, triggered);
}

void Output::fail(const std::string& reason) {
  throw BagError("cannot write " + path_ + " (" + reason +
                 "): choose another place or make room there");
}

}  // namespace wiimote_tracker
