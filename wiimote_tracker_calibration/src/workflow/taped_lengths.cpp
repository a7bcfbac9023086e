#include "workflow/taped_lengths.h"

#include "workflow/calibration.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

namespace {

// A length farther from that of the sides than this is a mistake [standard deviations].
constexpr double kMostDeviation = 10.0;

/// @returns whether any was dropped.
template <typename Condition>
bool drop(std::vector<square::TapedLength>* lengths, Condition condition) {
  const auto end = std::remove_if(lengths->begin(), lengths->end(), condition);
  const bool any = end != lengths->end();
  lengths->erase(end, lengths->end());
  return any;
}

}  // namespace

Reply takeLength(const square::TapedLength& taped, double placement, Captured* captured) {
  if (!captured->layout)
    return {false, captured->cameras.empty()
                       ? "no calibration is started: start one first"
                       : "this calibration has no square to measure: start one with a square"};
  const std::size_t count = captured->square.corners().size();
  if (taped.from >= count || taped.to >= count || taped.from == taped.to)
    return {false, format("a length is between two captured corners: %zu are captured, and corner "
                          "%zu to corner %zu was asked for",
                          count, taped.from + 1, taped.to + 1)};
  const std::string name = format("corner %zu to corner %zu", taped.from + 1, taped.to + 1);
  const auto same = [&](const square::TapedLength& other) { return taped.hasCornersOf(other); };
  std::vector<square::TapedLength>& lengths = captured->layout->lengths;
  if (taped.length == 0.0) {
    const bool dropped = drop(&lengths, same);
    return {dropped, (dropped ? "the length from " : "there is no length from ") + name +
                         (dropped ? " was dropped: solve again" : " to drop")};
  }
  if (!(taped.length > 0.0 && std::isfinite(taped.length) && taped.stddev > 0.0 &&
        std::isfinite(taped.stddev)))
    return {false, "a length and its standard deviation must be above 0: give them in metres"};
  const double by_sides = captured->layout->lengthBetween(taped.from, taped.to);
  const double most = kMostDeviation * std::hypot(M_SQRT2 * placement, taped.stddev);
  if (std::abs(taped.length - by_sides) > most)
    return {false, format("%s is %.3f m by the sides, at most %.0f mm more or less, but the tape "
                          "says %.3f m: measure again, in metres, or start again with other sides",
                          name.c_str(), by_sides, 1e3 * most, taped.length)};
  drop(&lengths, same);
  lengths.push_back(taped);
  return {true, format("%s is %.4f m by tape, %+.1f mm against the sides: solve again",
                       name.c_str(), taped.length, 1e3 * (taped.length - by_sides))};
}

void dropLengthsTo(std::size_t corner, Captured* captured) {
  drop(&captured->layout->lengths, [&](const square::TapedLength& taped) {
    return taped.from == corner || taped.to == corner;
  });
}

Reply takePlace(const square::KnownPlace& known,
                const capture::CapturedCorner& seen,
                Captured* captured) {
  if (!captured->layout || !captured->square.isComplete())
    return {false,
            "a known place is solved together with a square: capture its four corners first"};
  captured->layout->places.push_back(known);
  captured->places.push_back(seen);
  return {true, format("place %zu at (%.3f, %.3f, %.3f) m is captured by %zu cameras: solve again",
                       captured->places.size(), known.position.x(), known.position.y(),
                       known.position.z(), seen.size())};
}

bool dropLastPlace(Captured* captured) {
  if (captured->places.empty())
    return false;
  captured->places.pop_back();
  captured->layout->places.pop_back();
  return true;
}

Reply Calibration::measureLength(const square::TapedLength& taped, double placement) {
  if (busy_)
    return refuse(occupied());
  just_solved_ = false;
  return changed(takeLength(taped, placement, &captured_));
}

Reply Calibration::addPlace(const square::KnownPlace& known, const capture::CapturedCorner& seen) {
  if (captured_.square.isComplete() && (!rig_ || rig_->id() != captured_.solved_to))
    return refuse(
        "the rig in use is not the solution of the captured corners: solve first or, if a camera "
        "was changed since they were captured, calibrate again to use known places");
  return changed(takePlace(known, seen, &captured_));
}

}  // namespace wiimote_tracker::workflow
