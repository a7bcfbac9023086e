#include "health_view.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <iterator>

namespace wiimote_tracker::panel {

void HealthView::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message, double now) {
  for (const auto& status : message.status)
    entries_[status.name] = {status, now};
  for (auto entry = entries_.begin(); entry != entries_.end();)
    entry = now - entry->second.time > kForgetAfter ? entries_.erase(entry) : std::next(entry);
}

std::vector<diagnostic_msgs::DiagnosticStatus> HealthView::parts(double now) const {
  using diagnostic_msgs::DiagnosticStatus;
  std::vector<DiagnosticStatus> result;
  for (const auto& [name, entry] : entries_) {
    if (now - entry.time > kForgetAfter)  // Nothing has come since.
      continue;
    result.push_back(entry.status);
    if (now - entry.time > kStaleAfter) {
      result.back().level = DiagnosticStatus::STALE;
      result.back().message = format("says nothing for %.0f s", now - entry.time);
    }
  }
  std::stable_sort(
      result.begin(), result.end(),
      [](const DiagnosticStatus& a, const DiagnosticStatus& b) { return a.level > b.level; });
  return result;
}

}  // namespace wiimote_tracker::panel
