#ifndef WIIMOTE_TRACKER_TRIANGULATION_EVENTS_ZONE_WATCH_H
#define WIIMOTE_TRACKER_TRIANGULATION_EVENTS_ZONE_WATCH_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker::events {

/// An LED has entered or left a zone; fields as in ZoneEvent.msg.
struct ZoneCrossing {
  std::string zone;
  std::uint32_t led = 0;
  bool entered = false;  ///< Otherwise it has left, or was lost inside.
  double time = 0.0;     ///< When it crossed the border, was first known inside, or was lost [s].
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Where it was then [m].
};

struct ZoneWatchOptions {
  /// An LED has left a zone when it is farther outside than this [m, >= 0]; so noise at the border
  /// makes no events.
  double hysteresis = 0.05;

  /// An LED without a snapshot that shows it for longer than this is lost [s, > 0].
  double timeout = 1.0;
};

/// Tells when LEDs enter and leave the zones of a rig.
///
/// Between two snapshots an LED is taken to move in a straight line; so the time of a crossing is
/// finer than the snapshots are, and a zone thinner than a step is not missed. Tentative LEDs are
/// not counted. Does not allocate but for an event, a new LED or new zones.
class ZoneWatch {
 public:
  explicit ZoneWatch(const ZoneWatchOptions& options) : options_(options) {}

  /// From the next snapshot on. What is inside a zone of a name that stays is not reported again; a
  /// zone that is no longer there is left by all.
  void setZones(const std::vector<geometry::Zone>& zones);

  /// The events that this snapshot reveals: LED by LED in the order of their ids, first of those
  /// that have gone, each LED's own in the order of time. Valid until the next call. When time goes
  /// back, all LEDs known before are lost.
  const std::vector<ZoneCrossing>& update(const tracking::Snapshot& snapshot);

 private:
  struct Presence {
    bool inside = false;
    double crossed = 0.0;  // when it last went out through the border, while inside
    Eigen::Vector3d crossed_at = Eigen::Vector3d::Zero();
  };

  struct Led {
    std::uint32_t id = 0;
    double time = 0.0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::vector<Presence> presences;  // one per zone
  };

  void step(const Eigen::Vector3d& to, Led* led);
  void lose(const Led& led);

  ZoneWatchOptions options_;
  std::vector<geometry::Zone> zones_;
  std::vector<Led> leds_;  // in the order of their ids
  double newest_ = -std::numeric_limits<double>::infinity();
  std::vector<ZoneCrossing> gone_;  // of zones that were taken away, for the next snapshot
  std::vector<ZoneCrossing> crossings_;
};

}  // namespace wiimote_tracker::events

#endif  // WIIMOTE_TRACKER_TRIANGULATION_EVENTS_ZONE_WATCH_H
