#include "results.h"

#include "bodies/body_message.h"
#include "measurement_message.h"
#include "point_message.h"

#include <tf2_msgs/TFMessage.h>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

}  // namespace

Results::Results(const ResultFiles& files, const Topics& topics, bool has_thread)
    : topics_(topics),
      publish_predicted_(files.publish_predicted),
      bag_(files.bag),
      worker_(has_thread) {
  if (!files.csv.empty())
    tables_.push_back(measurements::makeCsvWriter(files.csv));
  if (!files.matlab.empty())
    tables_.push_back(measurements::makeMatlabWriter(files.matlab));
}

void Results::copy(const std::string& topic,
                   const ros::Time& time,
                   const std::shared_ptr<const MessageBytes>& message,
                   const boost::shared_ptr<ros::M_string>& header) {
  worker_.give([=] { bag_.copy(topic, time, *message, header); });
}

void Results::addRig(const wiimote_tracker_msgs::RigCalibration& rig, const ros::Time& time) {
  worker_.give([=] { bag_.write(topics_.rig(), time, rig, true); });
}

void Results::addPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points,
                        const ros::Time& time) {
  ++points_;
  for (const TrackedPoint& point : points->points)
    ids_.insert(point.id);
  worker_.give([=] { writePoints(*points, time); });
}

void Results::writePoints(const TrackedPointArray& points, const ros::Time& time) {
  bag_.write(topics_.points(), time, points);
  tf2_msgs::TFMessage transforms;
  for (const TrackedPoint& point : points.points) {
    if (!isPosition(point, publish_predicted_))
      continue;
    bag_.write(topics_.point(point.label), time, pointStamped(points, point));
    transforms.transforms.push_back(transform(points, point));
  }
  if (!transforms.transforms.empty())
    bag_.write(Topics::transforms(), time, transforms);
  writeTable(points, false);
}

void Results::addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
                        const ros::Time& time) {
  worker_.give([=] { writeBodies(bodies, time); });
}

void Results::writeBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
                          const ros::Time& time) {
  bag_.write(topics_.bodies(), time, bodies);
  tf2_msgs::TFMessage transforms;
  for (const wiimote_tracker_msgs::TrackedBody& body : bodies.bodies) {
    if (!isPose(body, publish_predicted_))
      continue;
    bag_.write(topics_.pose(body.name), time, poseStamped(bodies, body));
    transforms.transforms.push_back(transform(bodies, body));
  }
  if (!transforms.transforms.empty())
    bag_.write(Topics::transforms(), time, transforms);
}

void Results::addTriggeredPoints(const TrackedPointArray& points, const ros::Time& time) {
  ++triggers_answered_;
  worker_.give([=] {
    bag_.write(topics_.triggeredPoints(), time, points);
    writeTable(points, true);
  });
}

void Results::addZoneEvent(const wiimote_tracker_msgs::ZoneEvent& event, const ros::Time& time) {
  ++zone_events_;
  worker_.give([=] { bag_.write(topics_.zoneEvents(), time, event); });
}

void Results::writeTable(const TrackedPointArray& points, bool triggered) {
  for (const std::unique_ptr<measurements::Writer>& table : tables_)
    writeMeasurements(points, triggered, table.get());
}

void Results::finish() {
  worker_.finish();
  for (const std::unique_ptr<measurements::Writer>& table : tables_)
    table->finish();
  bag_.finish();
}

}  // namespace wiimote_tracker
