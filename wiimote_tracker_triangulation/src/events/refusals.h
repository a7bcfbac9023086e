#pragma once

#include "events/trigger.h"

#include <wiimote_tracker_msgs/text.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace wiimote_tracker::events {

/// Says which triggers got no points: the first one of each reason at once, further ones together,
/// at most once in kPeriod, since a publisher that errs may do so at a high rate.
class Refusals {
 public:
  static constexpr double kPeriod = 10.0;  ///< Between two sentences on one reason [s].

  explicit Refusals(const TriggerOptions& options) : options_(options) {}

  /// @param stamp the trigger's time [s], as text.
  void add(TriggerResult reason, const std::string& stamp) {
    Reason& r = reasons_[reason];
    r.repeats = r.count == 0 || (r.repeats && r.stamp == stamp);
    r.stamp = stamp;
    ++r.count;
  }

  /// A sentence that is due, if there is one. Call until there is none.
  /// @param now any time that goes on, such as that of images [s]; infinity: all that is left
  std::optional<std::string> next(double now) {
    for (auto& [result, reason] : reasons_) {
      // Time may also have jumped back.
      if (reason.count == 0 ||
          (reason.said && now >= *reason.said && now <= *reason.said + kPeriod))
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

 private:
  struct Reason {
    std::size_t count = 0;  // not said yet
    std::string stamp;      // of the last
    bool repeats = false;   // whether all had the same stamp
    std::optional<double> said;
  };

  TriggerOptions options_;
  std::map<TriggerResult, Reason> reasons_;
};

}  // namespace wiimote_tracker::events
