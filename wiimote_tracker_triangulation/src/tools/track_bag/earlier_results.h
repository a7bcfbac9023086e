#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_EARLIER_RESULTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_EARLIER_RESULTS_H

#include "recorded_message.h"
#include "topics.h"

#include <optional>
#include <set>
#include <string>

namespace wiimote_tracker {

/// Knows which messages of a bag a tracker computed before.
class EarlierResults {
 public:
  /// @param labels of LEDs, in the earlier results. @param bodies there.
  EarlierResults(const Topics& topics,
                 const std::set<std::string>& labels,
                 const std::set<std::string>& bodies);

  /// What of a message is not an earlier result; nothing when all of it is.
  std::optional<MessageBytes> rest(const rosbag::MessageInstance& message) const;

 private:
  std::set<std::string> topics_;
  std::set<std::string> frames_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_EARLIER_RESULTS_H
