#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_STREAM_WATCH_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_STREAM_WATCH_H

#include "wiimote/options.h"

#include <limits>

namespace wiimote_tracker::wiimote {

/// Decides what a session does, and when, to keep a stream of images alive.
class StreamWatch {
 public:
  enum class Task {
    kNothing,
    kRestart,          ///< No image for silence_timeout.
    kSetModeAndCheck,  ///< No image for 0.1 s: the report mode may be lost, or the camera off.
    kSetMode,          ///< A status came: the kernel's driver may have reset the report mode.
    kCheckInDark,      ///< No light for 0.5 s: the camera may be off. After disableChecks()
                       ///< repeated in pauses that double up to a minute.
    kCheckControl,     ///< After doubt().
    kCheckNext,        ///< The next periodic check of the camera's registers is due.
    kAskStatus,        ///< The next request for the battery level is due.
  };

  explicit StreamWatch(const Options& options) : options_(options) {}

  /// The camera is set up; images are expected from `now` [s] on.
  void start(double now);

  /// The camera's registers cannot be read on this remote: no periodic checks.
  void disableChecks() { checks_ = false; }

  /// The camera may have been changed.
  void doubt(double now) { control_due_ = now; }

  /// The camera is being set up: no doubt is left.
  void settle() { control_due_ = kNever; }

  /// Whether a doubt has not led to kCheckControl yet.
  bool doubted() const { return control_due_ != kNever; }

  /// Counts the silence from `now` [s] on.
  void expectImage(double now) { last_image_ = now; }

  /// An image has come that may not be of the camera as configured.
  void alive(double now);

  /// An image has come. @returns whether it shows the first light after darkness, within 0.1 s of
  /// kCheckInDark: then that check has switched the camera's logic on again.
  bool image(const protocol::DataReport& image, double now);

  /// A status has come. `camera`: whether it says that the camera is on.
  void status(bool camera, double now);

  /// Whether a status came within 0.2 s: then the kernel's driver has reset the report mode, and
  /// nothing else is wrong.
  bool justAfterStatus(double now) const;

  /// Whether no image has come for silence_timeout.
  bool silent(double now) const { return now >= last_image_ + options_.silence_timeout; }

  /// Whether a status that comes now may explain why images did not come.
  bool afterSilence(double now) const;

  /// Whether no light has been seen since kCheckInDark.
  bool dark() const { return dark_checked_; }

  /// The task that is due; it counts as done.
  Task take(double now);

  /// When something will be due [s].
  double deadline() const;

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  double modeCheckDue() const;
  void lightSeen(double now);

  Options options_;
  bool checks_ = true;

  double last_image_ = 0.0;
  bool mode_checked_ = false;  ///< Since the last image.
  double last_mode_check_ = -kNever;
  double last_status_ = -kNever;
  double mode_due_ = kNever;

  double dark_pause_ = 0.0;       ///< [s] Without a light, until the next kCheckInDark.
  double dark_check_from_ = 0.0;  ///< From then on a dark image makes it due.
  double dark_check_due_ = kNever;
  bool dark_checked_ = false;  ///< Since the last light.
  double last_dark_check_ = -kNever;

  double control_due_ = kNever;
  double check_due_ = kNever;
  double status_due_ = kNever;
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_STREAM_WATCH_H
