#include "wiimote/stream_watch.h"

#include <algorithm>

namespace wiimote_tracker::wiimote {
namespace {

// Time without an image after which the report mode is set again [s]. Of the intervals of real
// remotes one in a thousand is longer than half of this.
constexpr double kSilenceBeforeMode = 0.1;
// A status within this time after that may explain the silence [s].
constexpr double kSilenceEffect = 0.2;
// The kernel's driver resets the mode some milliseconds after each status. The session sets its own
// this long after the status [s].
constexpr double kModeAfterStatus = 0.03;
// A lost mode within this time after a status is due to the kernel's driver [s].
constexpr double kStatusEffect = 0.2;
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

bool StreamWatch::justAfterStatus(double now) const {
  return now < last_status_ + kStatusEffect;
}

bool StreamWatch::afterSilence(double now) const {
  return now < last_mode_check_ + kSilenceEffect;
}

double StreamWatch::modeCheckDue() const {
  return mode_checked_ ? kNever : last_image_ + kSilenceBeforeMode;
}

StreamWatch::Task StreamWatch::take(double now) {
  if (silent(now))
    return Task::kRestart;
  if (now >= mode_due_) {
    mode_due_ = kNever;
    return Task::kSetMode;
  }
  if (now >= modeCheckDue()) {
    mode_checked_ = true;
    last_mode_check_ = now;
    return Task::kSetModeAndCheck;
  }
  if (now >= dark_check_due_) {
    dark_check_due_ = kNever;
    dark_checked_ = true;
    last_dark_check_ = now;
    dark_pause_ = std::min(2.0 * dark_pause_, kLongestDarkPause);
    dark_check_from_ = checks_ ? kNever : now + dark_pause_;
    return Task::kCheckInDark;
  }
  if (now >= control_due_) {
    control_due_ = kNever;
    return Task::kCheckControl;
  }
  if (checks_ && now >= check_due_) {
    check_due_ = now + kCheckInterval;
    return Task::kCheckNext;
  }
  if (now >= status_due_) {
    status_due_ = now + options_.status_interval;
    return Task::kAskStatus;
  }
  return Task::kNothing;
}

double StreamWatch::deadline() const {
  return std::min({last_image_ + options_.silence_timeout, mode_due_, modeCheckDue(),
                   dark_check_due_, control_due_, checks_ ? check_due_ : kNever, status_due_});
}

}  // namespace wiimote_tracker::wiimote
