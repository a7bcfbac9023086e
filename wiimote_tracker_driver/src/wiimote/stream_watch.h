#pragma once

#include "wiimote/options.h"

#include <limits>
#include <optional>

namespace wiimote_tracker::wiimote {

/// Decides what a session does, and when, to keep a stream of images alive.
class StreamWatch {
 public:
  /// What is due, in the order in which it is done.
  struct Upkeep {
    bool images_stopped = false;  ///< No image for silence_timeout.
    bool ask_why_silent = false;  ///< Then nothing else is due.
    bool set_mode = false;
    bool start_logic = false;  ///< It cannot be read back, and may be repeated.
    bool ask_status = false;
    std::optional<int> check_block;  ///< One of CameraConfiguration::read().
    bool check_camera = false;       ///< All of them.
    bool after_silence = false;      ///< The check may explain why images do not come.
  };

  explicit StreamWatch(const Options& options) : options_(options) {}

  /// The camera is set up; images are expected from `now` [s] on.
  void start(double now);

  /// The camera's registers cannot be read on this remote: no periodic checks, and those in the
  /// dark in pauses that double up to a minute.
  void disableChecks() { checks_ = false; }

  /// The camera may have been changed.
  void doubt(double now) { control_due_ = now; }

  /// The camera is being set up: no doubt is left.
  void settle() { control_due_ = kNever; }

  /// Whether a doubt has not led to a check yet.
  bool doubted() const { return control_due_ != kNever; }

  /// Counts the silence from `now` [s] on.
  void expectImage(double now) { last_image_ = now; }

  /// An image has come that may not be of the camera as configured.
  void alive(double now);

  /// An image has come. @returns whether it shows the first light after darkness, within 0.1 s of
  /// a check in the dark: then that has switched the camera's logic on again.
  bool image(const protocol::DataReport& image, double now);

  /// A status has come. `camera`: whether it says that the camera is on.
  void status(bool camera, double now);

  /// Whether a status came within 0.2 s: then the kernel's driver has reset the report mode, and
  /// nothing else is wrong.
  bool justAfterStatus(double now) const { return now < last_status_ + kStatusEffect; }

  /// Whether no image has come for silence_timeout.
  bool silent(double now) const { return now >= last_image_ + options_.silence_timeout; }

  /// Whether a status that comes now may explain why images did not come.
  bool afterSilence(double now) const { return now < last_mode_check_ + kSilenceEffect; }

  /// How often images have stopped in a row, without an image between.
  int silences() const { return silences_; }

  /// What is due now; it counts as done.
  Upkeep take(double now);

  /// When something will be due [s].
  double deadline() const;

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  // A status within this time after a silence may explain it [s].
  static constexpr double kSilenceEffect = 0.2;
  // A lost mode within this time after a status is due to the kernel's driver [s].
  static constexpr double kStatusEffect = 0.2;

  double modeCheckDue() const;
  void lightSeen(double now);

  Options options_;
  bool checks_ = true;

  double last_image_ = 0.0;
  int silences_ = 0;
  bool mode_checked_ = false;  ///< Since the last image.
  double last_mode_check_ = -kNever;
  double last_status_ = -kNever;
  double mode_due_ = kNever;

  double dark_pause_ = 0.0;       ///< [s] Without a light, until the next check in the dark.
  double dark_check_from_ = 0.0;  ///< From then on a dark image makes it due.
  double dark_check_due_ = kNever;
  bool dark_checked_ = false;  ///< Since the last light.
  double last_dark_check_ = -kNever;

  double control_due_ = kNever;
  double check_due_ = kNever;
  int next_block_ = 0;  ///< That the next periodic check reads.
  double status_due_ = kNever;
};

}  // namespace wiimote_tracker::wiimote
