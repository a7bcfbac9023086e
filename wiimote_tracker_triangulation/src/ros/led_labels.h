#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_LABELS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_LABELS_H

#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// The names of the LEDs. A track that is confirmed takes the first name of a list that is free,
/// and keeps it until it is lost; then the name goes to the oldest track that has none, or to the
/// next that is confirmed. So a room with one LED always has it under the first name. A track
/// without a name of the list is called led_<id>.
class LedLabels {
 public:
  explicit LedLabels(const std::vector<std::string>& labels) : listed_(labels) {}

  /// Takes notice of a snapshot's LEDs; call with every snapshot.
  void update(const std::vector<tracking::TrackedLed>& leds);

  /// Of an LED of the last snapshot, or one that was lost there or by clear().
  std::string of(std::uint32_t id) const;

  /// All tracks are lost, and all labels free.
  void clear();

  /// What a track is called without a listed label.
  static std::string unlisted(std::uint32_t id) { return "led_" + std::to_string(id); }

 private:
  void giveFreeLabel(std::uint32_t id);
  bool isTaken(const std::string& label) const;

  std::vector<std::string> listed_;
  std::map<std::uint32_t, std::string> given_;  // listed ones, by id of the track
  std::vector<std::uint32_t> lost_;             // since the last update began
  std::vector<std::uint32_t> forgotten_;        // before; their labels are free
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_LABELS_H
