#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_INPUT_BAG_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_INPUT_BAG_H

#include "topics.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A recorded bag, its messages in the order in which a tracker gets them when nothing is delayed
/// on the way: images by their arrival, those of one arrival by their topics; every other message
/// before the image that was recorded next. Recorded times decide nothing else, so the clock of the
/// recorder does not matter.
class InputBag {
 public:
  /// @throws BagError: no such file, no bag, no index, recorded with other message definitions.
  explicit InputBag(const std::string& path);

  std::size_t size() const { return order_.size(); }

  /// The i-th in that order.
  const rosbag::MessageInstance& operator[](std::size_t i) const { return messages_[order_[i]]; }

  std::size_t images() const { return images_; }

  /// A recorded time before all others, as far as there is one. Only of a bag with messages.
  ros::Time justBefore() const;

  /// The topics of the tracker whose rig the bag holds; those without a namespace when it holds no
  /// rig. @throws BagError: rigs of several trackers.
  Topics topics() const;
  bool holdsRig() const { return !rig_topics_.empty(); }

  /// Of the LEDs in the points recorded on the topic.
  std::set<std::string> recordedLabels(const std::string& topic) const;

  /// Names of the bodies recorded on the topic.
  std::set<std::string> recordedBodies(const std::string& topic) const;

 private:
  void sort();

  std::string path_;
  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;            // the messages refer to it
  std::deque<rosbag::MessageInstance> messages_;  // as recorded
  std::vector<std::size_t> order_;
  std::size_t images_ = 0;
  std::set<std::string> rig_topics_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_INPUT_BAG_H
