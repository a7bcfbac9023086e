// Writes the tracker's points to tables while it runs.

#include "ros/measurement_message.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/parameter_reader.h>
#include <wiimote_tracker_msgs/run_node.h>

#include <memory>
#include <string>
#include <vector>

namespace {

using namespace wiimote_tracker;
using wiimote_tracker_msgs::TrackedPointArray;

class Recorder {
 public:
  /// @throws ParameterError, Error.
  Recorder(ros::NodeHandle nh, const ros::NodeHandle& private_nh) {
    ParameterReader reader(private_nh);
    const auto csv = reader.optional<std::string>("csv", "");
    const auto matlab = reader.optional<std::string>("matlab", "");
    const double flush_period = reader.bounded("flush_period", 1.0, 0.01, 3600.0);
    if (csv.empty() && matlab.empty())
      throw ParameterError("set " + reader.nameOf("csv") + " or " + reader.nameOf("matlab") +
                           ": the file to write");
    reader.refuseUnknown();
    if (!csv.empty())
      tables_.push_back(measurements::makeCsvWriter(csv));
    if (!matlab.empty())
      tables_.push_back(measurements::makeMatlabWriter(matlab));
    subscribers_ = {subscribe(&nh, "points", false), subscribe(&nh, "triggered_points", true)};
    timer_ = nh.createWallTimer(ros::WallDuration(flush_period), &Recorder::onTimer, this);
  }

  /// @throws Error.
  void finish() {
    for (const std::unique_ptr<measurements::Writer>& table : tables_)
      table->finish();
    ROS_INFO("%zu messages written.", messages_);
  }

 private:
  ros::Subscriber subscribe(ros::NodeHandle* nh, const std::string& topic, bool triggered) {
    return nh->subscribe<TrackedPointArray>(
        topic, 10000,
        [this, triggered](const auto& points) {
          ++messages_;
          for (const std::unique_ptr<measurements::Writer>& table : tables_)
            writeMeasurements(*points, triggered, table.get());
        },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }

  void onTimer(const ros::WallTimerEvent&) {
    for (const std::unique_ptr<measurements::Writer>& table : tables_)
      table->flush();
  }

  std::vector<std::unique_ptr<measurements::Writer>> tables_;
  std::size_t messages_ = 0;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace

int main(int argc, char** argv) {
  return wiimote_tracker::runNode(argc, argv, "record_points",
                                  [](const auto& nh, const auto& private_nh) {
                                    Recorder recorder(nh, private_nh);
                                    ros::spin();
                                    recorder.finish();
                                  });
}
