#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RESULTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RESULTS_H

#include "output_bag.h"
#include "topics.h"
#include "wiimote_tracker_triangulation/measurements/writer.h"
#include "worker.h"

#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/ZoneEvent.h>

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Where results go.
struct ResultFiles {
  std::string bag;
  std::string csv;                 ///< Empty: none.
  std::string matlab;              ///< Empty: none.
  bool publish_predicted = false;  ///< Hidden LEDs too have a point and a transform of their own.
};

/// Writes what the tracker finds, and what else goes into the bag, in the order of the calls, which
/// must come from one thread at a time.
class Results {
 public:
  /// @throws BagError, measurements::WriteError; so do all others, sooner or later.
  /// @param has_thread the files are written in a thread of its own.
  Results(const ResultFiles& files, const Topics& topics, bool has_thread);

  /// A message of the input as it is, of a connection with this header.
  void copy(const std::string& topic,
            const ros::Time& time,
            const std::shared_ptr<const MessageBytes>& message,
            const boost::shared_ptr<ros::M_string>& header);

  /// Latched.
  void addRig(const wiimote_tracker_msgs::RigCalibration& rig, const ros::Time& time);

  void addPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points,
                 const ros::Time& time);
  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies, const ros::Time& time);
  void addTriggeredPoints(const wiimote_tracker_msgs::TrackedPointArray& points,
                          const ros::Time& time);
  void addZoneEvent(const wiimote_tracker_msgs::ZoneEvent& event, const ros::Time& time);

  /// All files are whole and have their names.
  void finish();

  std::uint64_t points() const { return points_; }  ///< Messages on `points`.
  std::uint64_t leds() const { return ids_.size(); }
  std::uint64_t triggersAnswered() const { return triggers_answered_; }
  std::uint64_t zoneEvents() const { return zone_events_; }

 private:
  void writeTable(const wiimote_tracker_msgs::TrackedPointArray& points, bool triggered);
  void writeBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies, const ros::Time& time);
  void writePoints(const wiimote_tracker_msgs::TrackedPointArray& points, const ros::Time& time);

  Topics topics_;
  bool publish_predicted_;
  OutputBag bag_;
  std::vector<std::unique_ptr<measurements::Writer>> tables_;
  std::uint64_t points_ = 0;
  std::set<std::uint32_t> ids_;
  std::uint64_t triggers_answered_ = 0;
  std::uint64_t zone_events_ = 0;
  Worker worker_;  // goes first, its jobs need the others
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_RESULTS_H
