#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_STREAM_WATCH_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_STREAM_WATCH_H

#include "wiimote_tracker_driver/wiimote/session_options.h"

#include <limits>

namespace wiimote_tracker::wiimote {

/// Knows what is to be done, and when, to keep a stream of images alive.
class StreamWatch {
 public:
  enum class Task {
    kNothing,
    kRestart,       ///< No image for long.
    kRemind,        ///< No image for a while: perhaps the report mode was lost.
    kRepeatMode,    ///< A status came: perhaps the kernel's driver has reset the report mode.
    kCheckInDark,   ///< No light for long: perhaps the camera does not work.
    kCheckControl,  ///< The images look wrong: perhaps the camera is in another format.
    kCheckNext,     ///< It is time to check the next part of the camera's configuration.
    kAskStatus,     ///< It is time to ask for the battery.
  };

  explicit StreamWatch(const SessionOptions& options) : options_(options) {}

  /// The camera is set up; images are expected from `now` [s] on.
  void start(double now);

  /// The camera's registers cannot be read on this remote.
  void disableChecks() { checks_ = false; }

  /// Waits for images anew.
  void expectImage(double now) { last_image_ = now; }

  /// An image has come while the camera was stopped.
  void alive(double now);

  /// An image has come. @returns whether it shows the first light after darkness, so soon after
  /// kCheckInDark that it is owed to that.
  bool image(const protocol::DataReport& image, double now);

  /// A status has come; `camera`: it says that the camera is on.
  void status(bool camera, double now);

  /// Whether a status came a moment ago, so that a lost report mode has an innocent reason.
  bool justAfterStatus(double now) const;

  /// Whether images have failed to come for so long that the watchdog acts.
  bool silent(double now) const { return now >= last_image_ + options_.silence_timeout; }

  bool dark() const { return dark_checked_; }

  /// What is due; the answer counts as done.
  Task take(double now);

  /// When something will be due [s].
  double deadline() const;

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  double reminderDue() const;

  SessionOptions options_;
  bool checks_ = true;

  double last_image_ = 0.0;
  bool reminded_ = false;  ///< Since the last image.
  double last_status_ = -kNever;
  double mode_due_ = kNever;

  double dark_since_ = 0.0;
  double dark_check_due_ = kNever;
  bool dark_checked_ = false;  ///< In this darkness.
  double last_dark_check_ = -kNever;

  double control_due_ = kNever;
  double last_control_ = -kNever;
  double check_due_ = kNever;
  double status_due_ = kNever;
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_STREAM_WATCH_H
