#include "wiimote/stream_watch.h"

#include "wiimote/camera_configuration.h"

#include <algorithm>

namespace wiimote_tracker::wiimote {
namespace {

// Time without an image after which the report mode is set again [s]. Of the intervals of real
// remotes one in a thousand is longer than half of this.
constexpr double kSilenceBeforeMode = 0.1;
// The kernel's driver resets the mode some milliseconds after each status. The session sets its own
// this long after the status [s].
constexpr double kModeAfterStatus = 0.03;
// Time without a light after which the camera is checked [s].
constexpr double kDarkCheck = 0.5;
// Between two checks of the camera, each of a third of its registers [s]. A check costs one data
// report: one image in 200.
constexpr double kCheckInterval = 2.0;
// A light that appears within this time after a check in the dark is due to that check [s].
constexpr double kDarkCheckEffect = 0.1;
// Longest pause between two such checks [s].
constexpr double kLongestDarkPause = 60.0;

}  // namespace

void StreamWatch::start(double now) {
  last_image_ = now;
  mode_checked_ = false;
  mode_due_ = kNever;
  lightSeen(now);
  check_due_ = now + kCheckInterval;
  status_due_ = now + options_.status_interval;
}

void StreamWatch::alive(double now) {
  last_image_ = now;
  silences_ = 0;
  mode_checked_ = false;
}

void StreamWatch::lightSeen(double now) {
  dark_pause_ = kDarkCheck;
  dark_check_from_ = now + dark_pause_;
  dark_checked_ = false;
  dark_check_due_ = kNever;
}

bool StreamWatch::image(const protocol::DataReport& image, double now) {
  alive(now);
  if (std::none_of(image.spots.begin(), image.spots.end(),
                   [](const protocol::IrSpot& spot) { return spot.seen; })) {
    if (now >= dark_check_from_)
      dark_check_due_ = now;
    return false;
  }
  const bool due_to_check = dark_checked_ && now < last_dark_check_ + kDarkCheckEffect;
  lightSeen(now);
  return due_to_check;
}

void StreamWatch::status(bool camera, double now) {
  last_status_ = now;
  mode_due_ = now + kModeAfterStatus;
  if (!camera)
    doubt(now);
}

double StreamWatch::modeCheckDue() const {
  return mode_checked_ ? kNever : last_image_ + kSilenceBeforeMode;
}

StreamWatch::Upkeep StreamWatch::take(double now) {
  Upkeep due;
  if (silent(now)) {
    ++silences_;
    due.images_stopped = true;
    due.ask_why_silent = silences_ > 1 || !checks_;
    due.set_mode = due.check_camera = due.after_silence = !due.ask_why_silent;
  } else if (now >= mode_due_) {
    mode_due_ = kNever;
    due.set_mode = true;
  } else if (now >= modeCheckDue()) {  // the mode may be lost, or the camera off
    mode_checked_ = true;
    last_mode_check_ = now;
    due.set_mode = true;
    due.ask_status = !checks_;
    due.after_silence = checks_;
    if (checks_)
      due.check_block = 0;
  } else if (now >= dark_check_due_) {  // the camera may be off
    dark_check_due_ = kNever;
    dark_checked_ = true;
    last_dark_check_ = now;
    dark_pause_ = std::min(2.0 * dark_pause_, kLongestDarkPause);
    dark_check_from_ = checks_ ? kNever : now + dark_pause_;
    due.start_logic = due.check_camera = true;
  } else if (now >= control_due_) {
    control_due_ = kNever;
    due.check_block = 0;
  } else if (checks_ && now >= check_due_) {
    check_due_ = now + kCheckInterval;
    due.check_block = next_block_;
    due.start_logic = dark_checked_ && next_block_ == 0;
    next_block_ = (next_block_ + 1) % CameraConfiguration::kReads;
  } else if (now >= status_due_) {
    status_due_ = now + options_.status_interval;
    due.ask_status = true;
  }
  return due;
}

double StreamWatch::deadline() const {
  return std::min({last_image_ + options_.silence_timeout, mode_due_, modeCheckDue(),
                   dark_check_due_, control_due_, checks_ ? check_due_ : kNever, status_due_});
}

}  // namespace wiimote_tracker::wiimote
