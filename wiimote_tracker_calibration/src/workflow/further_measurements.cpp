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

Reply Calibration::measureLength(const square::TapedLength& taped, double placement) {
  if (busy_)
    return refuse(occupied());
  just_solved_ = false;
  if (!captured_.layout)
    return refuse(captured_.cameras.empty()
                      ? "no calibration is started: start one first"
                      : "this calibration has no square to measure: start one with a square");
  square::SquareLayout& layout = *captured_.layout;
  const std::size_t count = captured_.square.corners().size();
  if (taped.from >= count || taped.to >= count || taped.from == taped.to)
    return refuse(
        format("a length is between two captured corners: %zu are captured, and corner "
               "%zu to corner %zu was asked for",
               count, taped.from + 1, taped.to + 1));
  const std::string name = format("corner %zu to corner %zu", taped.from + 1, taped.to + 1);
  const auto same = [&](const square::TapedLength& other) { return taped.hasCornersOf(other); };
  if (taped.length == 0.0) {
    const bool dropped = drop(&layout.lengths, same);
    return changed({dropped, (dropped ? "the length from " : "there is no length from ") + name +
                                 (dropped ? " was dropped: solve again" : " to drop")});
  }
  if (!(taped.length > 0.0 && std::isfinite(taped.length) && taped.stddev > 0.0 &&
        std::isfinite(taped.stddev)))
    return refuse("a length and its standard deviation must be above 0: give them in metres");
  const double by_sides = layout.lengthBetween(taped.from, taped.to);
  const double most = kMostDeviation * std::hypot(M_SQRT2 * placement, taped.stddev);
  if (std::abs(taped.length - by_sides) > most)
    return refuse(
        format("%s is %.3f m by the sides, at most %.0f mm more or less, but the tape "
               "says %.3f m: measure again, in metres, or start again with other sides",
               name.c_str(), by_sides, 1e3 * most, taped.length));
  drop(&layout.lengths, same);
  layout.lengths.push_back(taped);
  captured_.length_is_last = true;
  return changed({true, format("%s is %.4f m by tape, %+.1f mm against the sides: solve again",
                               name.c_str(), taped.length, 1e3 * (taped.length - by_sides))});
}

void Captured::dropLengthsTo(std::size_t corner) {
  drop(&layout->lengths, [&](const square::TapedLength& taped) {
    return taped.from == corner || taped.to == corner;
  });
}

bool Captured::dropLastPlace() {
  if (places.empty())
    return false;
  places.pop_back();
  layout->places.pop_back();
  return true;
}

Reply Calibration::addPlace(const square::KnownPlace& known, const capture::CapturedCorner& seen) {
  if (captured_.square.isComplete() && (!rig_ || rig_->id() != captured_.solved_to))
    return refuse(
        "the rig in use is not the solution of the captured corners: solve first or, if a camera "
        "was changed since they were captured, calibrate again to use known places");
  if (!captured_.layout || !captured_.square.isComplete())
    return refuse("a known place is solved together with a square: capture its four corners first");
  captured_.layout->places.push_back(known);
  captured_.places.push_back(seen);
  captured_.length_is_last = false;
  return changed(
      {true, format("place %zu at (%.3f, %.3f, %.3f) m is captured by %zu cameras: solve again",
                    captured_.places.size(), known.position.x(), known.position.y(),
                    known.position.z(), seen.size())});
}

Reply Calibration::undo() {
  if (busy_)
    return refuse(occupied());
  just_solved_ = false;
  if (captured_.length_is_last && !captured_.layout->lengths.empty()) {
    const square::TapedLength last = captured_.layout->lengths.back();
    return measureLength({last.from, last.to, 0.0}, 0.0);
  }
  if (captured_.dropLastPlace())
    return changed({true, "the last known place was dropped: solve again"});
  if (captured_.wave) {
    captured_.wave.reset();
    return changed({true, "the wave was dropped: record it again"});
  }
  const Reply reply = captured_.square.undo();
  if (reply.success)
    captured_.dropLengthsTo(captured_.square.corners().size());
  return changed(reply);
}

}  // namespace wiimote_tracker::workflow
