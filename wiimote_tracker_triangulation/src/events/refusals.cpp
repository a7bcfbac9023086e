#include "events/refusals.h"

#include <wiimote_tracker_msgs/text.h>

namespace wiimote_tracker::events {

void Refusals::add(TriggerResult reason, const std::string& stamp) {
  Reason& r = reasons_[reason];
  r.repeats = r.count == 0 || (r.repeats && r.stamp == stamp);
  r.stamp = stamp;
  ++r.count;
}

std::optional<std::string> Refusals::next(double now) {
  for (auto& [result, reason] : reasons_) {
    // Time may also have jumped back.
    if (reason.count == 0 || (reason.said && now >= *reason.said && now <= *reason.said + kPeriod))
      continue;
    const std::string triggers =
        reason.count == 1 ? "the trigger" : format("%zu triggers, the last", reason.count);
    const char* cause = result != TriggerResult::kNoTime && reason.count > 1 && reason.repeats
                            ? "; all had one stamp, as rostopic pub -r gives without -s"
                            : "";
    reason.said = now;
    reason.count = 0;
    return format("there are no points for %s at %s s: %s%s", triggers.c_str(),
                  reason.stamp.c_str(), describe(result, options_).c_str(), cause);
  }
  return std::nullopt;
}

}  // namespace wiimote_tracker::events
