#ifndef WIIMOTE_TRACKER_TRIANGULATION_EVENTS_REFUSALS_H
#define WIIMOTE_TRACKER_TRIANGULATION_EVENTS_REFUSALS_H

#include "events/trigger.h"

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
  void add(TriggerResult reason, const std::string& stamp);

  /// A sentence that is due, if there is one. Call until there is none.
  /// @param now any time that goes on, such as that of images [s]; infinity: all that is left
  std::optional<std::string> next(double now);

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

#endif  // WIIMOTE_TRACKER_TRIANGULATION_EVENTS_REFUSALS_H
