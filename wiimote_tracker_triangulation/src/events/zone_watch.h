#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::events {

/// An LED has entered or left a zone; fields as in ZoneEvent.msg.
struct ZoneCrossing {
  std::string zone;
  std::uint32_t led = 0;
  bool entered = false;  ///< Otherwise it has left, or was lost inside.
  double time = 0.0;     ///< Of the crossing, the first point inside, or the loss [s].
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< At that time [m].
};

struct ZoneWatchOptions {
  /// An LED leaves a zone when it is farther outside than this [m, >= 0], so that noise at the
  /// border causes no events.
  double hysteresis = 0.05;

  /// An LED that no snapshot shows for longer than this is lost [s, > 0].
  double timeout = 1.0;
};

/// Reports LEDs that enter and leave the zones of a rig. An LED moves in a straight line between
/// two snapshots: crossing times are finer than the interval of the snapshots, and thin zones are
/// not missed. Tentative LEDs are ignored. Allocates only for an event, a new LED or new zones.
class ZoneWatch {
 public:
  explicit ZoneWatch(const ZoneWatchOptions& options) : options_(options) {}

  /// Takes effect with the next snapshot. LEDs inside a zone whose name remains are not reported
  /// again; all LEDs leave a removed zone.
  void setZones(const std::vector<geometry::Zone>& zones);

  /// All LEDs leave with the next snapshot, whose time may be earlier.
  void loseAll();

  /// The events of this snapshot: by LED in the order of ids, lost LEDs first, each LED's sorted by
  /// time. Valid until the next call.
  const std::vector<ZoneCrossing>& update(const tracking::Snapshot& snapshot);

 private:
  struct Presence {
    bool inside = false;
    double crossed = 0.0;  // last crossing outwards while inside [s]
    Eigen::Vector3d crossed_at = Eigen::Vector3d::Zero();
  };

  struct Led {
    std::uint32_t id = 0;
    double time = 0.0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::map<std::string, Presence> presences;  // by the zone's name; none: never inside
  };

  void step(const Eigen::Vector3d& to, Led* led);
  void lose(const Led& led, std::vector<ZoneCrossing>* crossings) const;

  ZoneWatchOptions options_;
  std::vector<geometry::Zone> zones_;
  std::vector<Led> leds_;  // sorted by id
  double newest_ = -std::numeric_limits<double>::infinity();
  std::vector<ZoneCrossing> gone_;  // of removed zones and all LEDs, for the next snapshot
  std::vector<ZoneCrossing> crossings_;
};

}  // namespace wiimote_tracker::events
