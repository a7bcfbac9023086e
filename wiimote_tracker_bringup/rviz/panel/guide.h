#pragma once

#include <wiimote_tracker_msgs/CalibrationStatus.h>
#include <wiimote_tracker_msgs/CalibrationVerdict.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::panel {

/// The one thing to do next.
struct Advice {
  std::string title;     ///< In one or two words, to be read from afar.
  std::string sentence;  ///< The same in full.
  std::string button;    ///< What the button says that does it; empty: nothing to press.
  std::string request;   ///< Service or action below calibration/ that the button asks for.
  int corner = -1;       ///< To take again, 0..3; -1: the next one.
};

/// Where a person stands in the calibration; the node says what to do next. Times are of one steady
/// clock [s].
class Guide {
 public:
  static constexpr double kSilentAfter = 3.0;  ///< The node's status comes twice a second [s].

  void onStatus(const wiimote_tracker_msgs::CalibrationStatus& status, double now);
  void onVerdict(const wiimote_tracker_msgs::CalibrationVerdict& verdict) { verdict_ = verdict; }
  void onRequest(const std::string& service);
  void onProgress(const std::string& text, double share);
  void onAnswer(const std::string& service, const std::string& text);

  Advice advice(double now) const;

  /// What the node last said: an answer, or how far it is.
  std::string answer() const;
  /// Of the running step [0..1].
  double progress() const;
  /// What is missing and what is wrong, the most urgent first, one sentence each.
  std::vector<std::string> remarks() const;

  bool isSilent(double now) const { return !status_ || now - status_at_ > kSilentAfter; }
  /// Whether a request has not been answered, or its effect is not known yet.
  bool isWaiting() const { return !running_.empty() || !is_effect_known_; }
  const std::string& running() const { return running_; }  ///< Service; empty: none.
  /// Whether something goes on that cancel would end.
  bool isBusy() const;
  const std::optional<wiimote_tracker_msgs::CalibrationStatus>& status() const { return status_; }
  /// Of the current rig; null when there is none.
  const wiimote_tracker_msgs::CalibrationVerdict* verdict() const;

 private:
  using Status = wiimote_tracker_msgs::CalibrationStatus;

  std::optional<Status> status_;
  std::optional<wiimote_tracker_msgs::CalibrationVerdict> verdict_;
  double status_at_ = 0.0;
  bool is_effect_known_ = true;  // A status has come since the last answer.
  bool is_lost_ = false;  // Since the last request the node was started again, amid a calibration.
  std::string running_, answer_, progress_text_;
  double progress_ = 0.0;
};

}  // namespace wiimote_tracker::panel
