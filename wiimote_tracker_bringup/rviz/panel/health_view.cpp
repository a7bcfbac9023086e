#include "health_view.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>

namespace wiimote_tracker::panel {

std::vector<diagnostic_msgs::DiagnosticStatus> HealthView::parts(double now) const {
  using diagnostic_msgs::DiagnosticStatus;
  std::vector<DiagnosticStatus> result;
  for (const auto& [name, entry] : entries_) {
    if (now - entry.time > kForgetAfter)
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
