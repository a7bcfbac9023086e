#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::panel {

/// The latest diagnostics of every part. Times are of one steady clock [s].
class HealthView {
 public:
  static constexpr double kStaleAfter = 5.0;    ///< Parts report every second [s].
  static constexpr double kForgetAfter = 60.0;  ///< [s]

  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message, double now);

  /// By level, the worst first, then by name. What was not heard of lately is STALE.
  std::vector<diagnostic_msgs::DiagnosticStatus> parts(double now) const;

 private:
  struct Entry {
    diagnostic_msgs::DiagnosticStatus status;
    double time;  // [s]
  };

  std::map<std::string, Entry> entries_;
};

}  // namespace wiimote_tracker::panel
