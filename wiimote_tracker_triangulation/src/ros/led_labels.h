#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_LABELS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_LABELS_H

#include "wiimote_tracker_triangulation/identity/identifier.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// What an LED is called.
struct LedLabel {
  std::string name;

  /// Of a name that was told by blinking: its probability [0..1], and since when it stands [s]. NaN
  /// and 0 for others.
  double confidence = std::numeric_limits<double>::quiet_NaN();
  double since = 0.0;
};

/// The names of the LEDs. One that blinks has the label of its code, as soon as it is decided and
/// until evidence is against it. Of the others, a track that is confirmed takes the first name of a
/// list that is free, and keeps it until it is lost; then the name goes to the oldest track that
/// has none, or to the next that is confirmed. So a room with one LED always has it under the first
/// name. A track without a name is called led_<id>.
class LedLabels {
 public:
  explicit LedLabels(const std::vector<std::string>& labels) : listed_(labels) {}

  /// Takes notice of a snapshot's LEDs; call with every snapshot.
  /// @param identifier that has had the same snapshot; null: no LED blinks. With it, only LEDs that
  /// are known not to blink take names of the list.
  void update(const std::vector<tracking::TrackedLed>& leds,
              const identity::Identifier* identifier = nullptr);

  /// Of an LED of the last snapshot, or one that was lost there or by clear().
  LedLabel of(std::uint32_t id) const;

  /// All tracks are lost, and all labels free.
  void clear();

  /// What a track is called without a label.
  static std::string unlisted(std::uint32_t id) { return "led_" + std::to_string(id); }

 private:
  void takeIdentity(std::uint32_t id, const identity::Identifier& identifier);
  void giveFreeLabel(std::uint32_t id);
  bool isTaken(const std::string& label) const;

  std::vector<std::string> listed_;
  std::map<std::uint32_t, LedLabel> given_;  // listed ones and told ones, by id of the track
  std::vector<std::uint32_t> lost_;          // since the last update began
  std::vector<std::uint32_t> forgotten_;     // before; their labels are free
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LED_LABELS_H
