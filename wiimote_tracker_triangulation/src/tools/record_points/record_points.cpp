// Writes the tracker's points to tables while it runs.

#include "ros/measurements/writer.h"

#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/parameter_reader.h>
#include <wiimote_tracker_msgs/run_node.h>
#include <wiimote_tracker_msgs/text.h>

#include <ros/master.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace wiimote_tracker;
using wiimote_tracker_msgs::TrackedPointArray;

constexpr char kPurpose[] =
    "Writes points, triggered_points and bodies to files, until it is ended.\n"
    "\n"
    "  roslaunch wiimote_tracker_triangulation record_points.launch csv:=FILE\n"
    "\n"
    "Private parameters; one file at least is needed:\n"
    "  csv, matlab    of all points and bodies, as CSV (bodies: NAME_bodies.csv beside NAME.csv) "
    "or\n"
    "                 for MATLAB\n"
    "  c3d, trc       of the tracked LEDs, also of bodies, for other programs\n"
    "  tum            folder for the poses of bodies, <body>.tum, for evo\n"
    "  rate           of C3D and TRC [Hz], 1 to 1000 (default: 100)\n"
    "  flush_period   time between two writes to the files [s], 0.01 to 3600 (default: 1)";

constexpr double kLate = 10.0;  // without points, after which a person is told [s]

class Recorder {
 public:
  /// @throws ParameterError, Error.
  Recorder(ros::NodeHandle nh, const ros::NodeHandle& private_nh) {
    ParameterReader reader(private_nh);
    measurements::OutputNames files;
    reader.read("csv", &files.csv);
    reader.read("matlab", &files.matlab);
    reader.read("c3d", &files.c3d);
    reader.read("trc", &files.trc);
    reader.read("tum", &files.tum);
    reader.read("rate", &files.rate, 1.0, 1000.0);
    const double flush_period = reader.bounded("flush_period", 1.0, 0.01, 3600.0);
    reader.refuseUnknown();
    writers_ = measurements::makeWriters(files);
    if (writers_.empty())
      throw ParameterError("set " + reader.nameOf("csv") + " or " + reader.nameOf("matlab") +
                           ", c3d, trc or tum: the file to write");
    has_tables_ = writers_.size() > (files.tum.empty() ? 0 : 1);
    topic_ = nh.resolveName("points");
    subscribers_ = {subscribe(&nh, "points", false), subscribe(&nh, "triggered_points", true)};
    subscribers_.push_back(nh.subscribe("bodies", 10000, &Recorder::addBodies, this));
    timer_ = nh.createWallTimer(ros::WallDuration(flush_period), &Recorder::onTimer, this);
    late_timer_ = nh.createWallTimer(ros::WallDuration(kLate), &Recorder::onLate, this);
  }

  /// Speaks without rosconsole, which may have ended by then. @returns whether all files are whole.
  bool finish() {
    bool whole = true;
    for (const std::unique_ptr<measurements::Writer>& writer : writers_) {
      try {
        const std::string sentence = writer->finish();
        if (!sentence.empty())
          std::printf("record_points: %s.\n", sentence.c_str());
      } catch (const std::exception& e) {  // the data of the others are still in memory
        std::fprintf(stderr, "record_points: %s\n", e.what());
        whole = false;
      }
    }
    if (messages_ > 0)
      std::printf("record_points: %zu messages came.\n", messages_);
    else if (has_tables_)
      std::fprintf(stderr, "record_points: %s.\n", describeNoPoints().c_str());
    return whole;
  }

 private:
  ros::Subscriber subscribe(ros::NodeHandle* nh, const std::string& topic, bool triggered) {
    return nh->subscribe<TrackedPointArray>(
        topic, 10000,
        [this, triggered](const auto& points) {
          ++messages_;
          for (const std::unique_ptr<measurements::Writer>& writer : writers_)
            writer->addAll(*points, triggered);
        },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }

  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
    ++of_bodies_;
    for (const std::unique_ptr<measurements::Writer>& writer : writers_)
      writer->addBodies(bodies);
  }

  /// What there is instead, and what to do.
  std::string describeNoPoints() const {
    const std::string what =
        "no points came on " + topic_ +
        (of_bodies_ > 0 ? ", but " + counted(of_bodies_, "message") + " of bodies" : "") + ": ";
    if (std::find(published_.begin(), published_.end(), topic_) != published_.end())
      return what + "check that the cameras send images to the tracker that publishes it";
    if (!published_.empty())
      return what + "record in the namespace of " + joined(published_);
    return what + "start the tracker, or record in its namespace";
  }

  void onLate(const ros::WallTimerEvent&) {
    if (messages_ > 0 || !has_tables_ || !ros::master::check())
      return;
    ros::master::V_TopicInfo topics;
    ros::master::getTopics(topics);
    published_.clear();
    for (const ros::master::TopicInfo& topic : topics) {
      if (topic.datatype == ros::message_traits::datatype<TrackedPointArray>() &&
          topic.name.find("triggered") == std::string::npos)
        published_.push_back(topic.name);
    }
    ROS_WARN_STREAM(describeNoPoints());
  }

  void onTimer(const ros::WallTimerEvent&) {
    for (const std::unique_ptr<measurements::Writer>& writer : writers_)
      writer->flush();
  }

  std::vector<std::unique_ptr<measurements::Writer>> writers_;
  bool has_tables_ = false;  // of points
  std::string topic_;
  std::size_t messages_ = 0;
  std::size_t of_bodies_ = 0;
  std::vector<std::string> published_;  // topics of points, while none came
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
  ros::WallTimer late_timer_;
};

/// Takes what comes until the node is to end, or a file cannot be written. @returns whether all
/// that came was taken.
bool record() {
  try {
    ros::spin();
    return true;
  } catch (const std::exception& e) {  // the other files can still be completed
    ROS_FATAL("%s", e.what());
    return false;
  }
}

}  // namespace

int main(int argc, char** argv) {
  bool whole = true;
  const int status = wiimote_tracker::runNode(argc, argv, "record_points", kPurpose,
                                              [&whole](const auto& nh, const auto& private_nh) {
                                                Recorder recorder(nh, private_nh);
                                                const bool all_taken = record();
                                                whole = recorder.finish() && all_taken;
                                              });
  return whole ? status : 1;
}
