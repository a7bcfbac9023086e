#include "wiimote/wiimote.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace wiimote_tracker::wiimote {

using protocol::DataReport;

namespace {
// The kernel's buffer of 63 reports holds this much of a stream [s].
constexpr double kBufferedTime = 0.6;
// Between two attempts to connect [s]; doubles with each failure.
constexpr double kShortestPause = 0.25;
constexpr double kLongestPause = 0.5;
}  // namespace

Wiimote::Wiimote(const Options& options, transport::Opener open, Clock clock)
    : options_(options),
      open_(std::move(open)),
      clock_(std::move(clock)),
      retry_pause_(kShortestPause),
      next_attempt_(clock_()) {}

Wiimote::~Wiimote() {
  close();
}

double Wiimote::idleTime() const {
  return session_ ? 0.0 : std::max(0.0, next_attempt_ - clock_());
}

std::optional<DataReport> Wiimote::step(double max_wait) {
  std::optional<DataReport> image;
  dropOnException([&] {
    if (session_)
      image = receive(max_wait);
    else if (clock_() >= next_attempt_)
      connect();
  });
  return image;
}

template <typename Action>
void Wiimote::dropOnException(Action action) {
  try {
    action();
  } catch (const std::exception& e) {  // TransportError, SessionError; also std::bad_alloc
    drop(e.what());
  }
}

void Wiimote::connect() {
  transport_ = open_(delivered_);
  delivered_ = false;
  link_.state = Link::State::kStarting;
  link_.remote = transport_->remote();
  link_.status.reset();
  ++link_changes_;
  beginEpoch();
  queue_ = transport::QueueWatch(clock_());
  backlog_ = false;
  session_.emplace(
      options_, [this](const protocol::Report& report) { transport_->write(report); }, clock_());
}

std::optional<DataReport> Wiimote::receive(double max_wait) {
  const double wait = std::clamp(session_->deadline() - clock_(), 0.0, max_wait);
  protocol::Report report;
  double now = 0.0;
  const auto read = [&](double timeout) {
    const bool received = transport_->read(report, timeout);
    now = clock_();
    queue_.readEnded(received, timeout, now);
    return received;
  };
  bool received = read(0.0);
  if (!received) {
    backlog_ = false;
    received = wait > 0.0 && read(wait);
  }
  backlog_ = received && (backlog_ || queue_.age() > std::max(kBufferedTime, 2.0 * wait));
  std::optional<DataReport> image;
  if (received)
    image = session_->handle(report, now);
  // At the end of a stall what the session waits for may wait behind this report.
  if (!received || wait > 0.0)
    session_->tick(now);
  if (session_->takeRestart())
    beginEpoch();
  // The exposure clock takes the time of an epoch's first image for its arrival.
  const bool first = new_epoch_ || !had_image_;
  if (backlog_ || (queue_.waited() && first))
    image.reset();
  if (image) {
    had_image_ = true;
    delivered_ = true;
    retry_pause_ = kShortestPause;
    if (new_epoch_) {
      new_epoch_ = false;
      ++link_.clock_epoch;
      ++link_changes_;
    }
  }
  updateLink(image.has_value());
  return image;
}

void Wiimote::updateLink(bool image) {
  Link::State state = link_.state;
  if (image)
    state = Link::State::kStreaming;
  else if (!session_->streaming())
    state = Link::State::kStarting;
  const bool new_status = session_->status() && !(link_.status == session_->status());
  if (const char* restored = session_->takeRestoration()) {
    ++link_.restorations;
    link_.last_restoration = restored;
    ++link_changes_;
  }
  if (state == link_.state && !new_status)
    return;
  if (state == Link::State::kStreaming) {
    link_.error.clear();
    accelerometer_ =
        session_->factory().accelerometer().value_or(protocol::AccelerometerCalibration());
    link_.accelerometer_calibrated = session_->factory().accelerometer().has_value();
    link_.accelerometer_unknown = !session_->factory().accelerometerWasRead();
    link_.ir_calibration = session_->factory().ir();
  }
  link_.state = state;
  link_.status = session_->status();
  ++link_changes_;
}

void Wiimote::drop(const std::string& error) {
  session_.reset();
  transport_.reset();
  link_.state = Link::State::kSearching;
  link_.error = error;
  ++link_changes_;
  next_attempt_ = clock_() + retry_pause_;
  retry_pause_ = std::min(2.0 * retry_pause_, kLongestPause);
}

void Wiimote::setSensitivity(const protocol::IrSensitivity& sensitivity) {
  if (sensitivity == options_.sensitivity)
    return;
  options_.sensitivity = sensitivity;
  if (session_)
    dropOnException([&] { session_->setSensitivity(sensitivity, clock_()); });
}

void Wiimote::setLeds(std::uint8_t leds) {
  options_.leds = leds;
  if (session_)
    dropOnException([&] { session_->setLeds(leds); });
}

void Wiimote::setRumble(bool rumble) {
  if (session_)
    dropOnException([&] { session_->setRumble(rumble, clock_()); });
}

void Wiimote::close() {
  if (!session_)
    return;
  try {
    session_->switchOff();
  } catch (const std::exception&) {
    // The remote has disconnected already.
  }
  drop("");
}

}  // namespace wiimote_tracker::wiimote
