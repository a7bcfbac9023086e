#pragma once

#include "recording.h"
#include "ros/measurements/writer.h"
#include "ros/tracker/message_tracker.h"

#include <geometry_msgs/TransformStamped.h>
#include <rosbag/bag.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Writes the tracker's results and recorded messages to a new bag, and results to tables. The
/// files get their names in finish(); existing files are kept as path + ".bak". Without it, the
/// parts of all of them are removed. All member functions throw BagError or Error.
class Output : public MessageSink {
 public:
  /// @param options which topics of single LEDs and bodies to write.
  Output(const std::string& bag,
         const measurements::OutputNames& names,
         const Topics& topics,
         const OutputOptions& options);
  ~Output() override;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  /// The results of these LEDs and bodies in the recording are not copied.
  void dropRecorded(const std::set<std::string>& labels, const std::set<std::string>& bodies);

  /// Copies a recorded message, but for those results.
  void copy(const rosbag::MessageInstance& recorded);

  /// Latched.
  void writeRig(const wiimote_tracker_msgs::RigCalibration& rig, const ros::Time& time);

  /// Sets the recorded time of the following results, or keeps the present one if that is later:
  /// results are in the bag in the order in which they were computed.
  void setTime(const ros::Time& recorded) { now_ = std::max(now_, recorded); }

  void finish();

  std::uint64_t points() const { return points_; }  ///< Messages on `points`.
  std::uint64_t leds() const { return ids_.size(); }
  std::uint64_t triggersAnswered() const { return triggers_answered_; }
  std::uint64_t zoneEvents() const { return zone_events_; }

  void onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points,
                const std::vector<tracking::CameraView>& views) override;
  void onBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
                const std::vector<bool>& bridged) override;
  void onZoneEvent(const wiimote_tracker_msgs::ZoneEvent& event) override;
  void onTriggeredPoints(const wiimote_tracker_msgs::TrackedPointArray& points) override;
  void onProblem(const std::string& sentence) override;

 private:
  template <typename Message>
  void write(const std::string& topic,
             const ros::Time& time,
             const Message& message,
             const boost::shared_ptr<ros::M_string>& header = nullptr);
  void writeTransforms(const std::vector<geometry_msgs::TransformStamped>& transforms);
  void writeMeasurements(const wiimote_tracker_msgs::TrackedPointArray& points, bool triggered);
  [[noreturn]] void fail(const std::string& reason);
  /// Removes all parts, and leaves the bag open until the process ends. Nothing if it is finished.
  void abandon();

  std::string path_;
  Topics topics_;
  OutputOptions options_;
  geometry::OutputFile part_;         // of the bag, which rosbag writes
  std::unique_ptr<rosbag::Bag> bag_;  // null when finished
  std::vector<std::unique_ptr<measurements::Writer>> writers_;
  std::set<std::string> dropped_topics_;  // of the recording
  std::set<std::string> dropped_frames_;  // of its transforms
  ros::Time now_;
  std::uint64_t points_ = 0;
  std::set<std::uint32_t> ids_;
  std::uint64_t triggers_answered_ = 0;
  std::uint64_t zone_events_ = 0;
};

}  // namespace wiimote_tracker
