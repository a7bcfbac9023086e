#pragma once

#include "waved_led.h"

#include "health/health_watch.h"

#include <wiimote_tracker_triangulation/tracking/tracker.h>

#include <cstdint>
#include <set>

namespace wiimote_tracker {

/// What happened in some hours.
struct MonthFigures {
  std::uint64_t images = 0;
  std::uint64_t points = 0;      ///< TRACKED.
  std::uint64_t wrong = 0;       ///< Of them: off by 5 cm and by five standard deviations.
  std::uint64_t hours_dark = 0;  ///< In which less than half of the images gave a point.
  std::uint64_t reused_ids = 0;
  std::uint64_t alarms = 0;  ///< Sentences about cameras that moved.
  double squared = 0.0;      ///< Errors of the points that are not wrong [m^2].
};

/// A tracker and a health watch that run for weeks: a part of each hour is simulated, the rest of
/// it passes at once. One LED moves before four cameras.
///
/// Each hour another camera reconnects. The time offset of the fourth one is then another (3 ms).
/// The clock of the second one drifts by 100 ppm and is set right once an hour. After each 40 hours
/// the batteries of a camera are empty for an hour. In the middle of hour 240 all clocks jump back
/// by a leap second.
class Month {
 public:
  /// @param part of each hour that is simulated [s].
  Month(std::uint64_t seed, double part);

  /// Simulates the next hours.
  MonthFigures run(int hours);

  /// Turns the first camera about the x axis of its image [rad].
  void knock(double angle);

  /// Of an LED so far; -1: none.
  std::int64_t highestId() const { return highest_id_; }

 private:
  void runHour(MonthFigures* figures);
  void reconnect(std::size_t camera);
  void add(const capture::Image& image, MonthFigures* figures);
  void takePoints(MonthFigures* figures);
  void addAccelerations(double time);

  const double part_;
  square::Random random_;
  const geometry::Rig rig_;
  WavedLed led_;
  tracking::Tracker tracker_;
  health::HealthWatch health_;
  std::vector<std::uint32_t> epochs_;
  int hour_ = 0;
  double clock_step_ = 0.0;  // of all clocks [s]
  std::int64_t highest_id_ = -1;
  std::set<std::uint32_t> ids_;  // of the newest snapshot
};

}  // namespace wiimote_tracker
