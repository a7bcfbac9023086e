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
  begins_epoch_ = true;
  queue_ = transport::QueueWatch(clock_());
  backlog_ = false;
  session_.emplace(
      options_, [this](const protocol::Report& report) { transport_->write(report); }, clock_());
}

// Takes a report that has come already, else waits for one.
bool Wiimote::read(protocol::Report& report, double wait) {
  const auto readFor = [&](double timeout) {
    const bool received = transport_->read(report, timeout);
    queue_.readEnded(received, timeout, clock_());
    return received;
  };
  const bool had_come = readFor(0.0);
  const bool received = had_come || (wait > 0.0 && readFor(wait));
  const bool too_old = queue_.age() > std::max(kBufferedTime, 2.0 * wait);
  backlog_ = received && (too_old || (had_come && backlog_));
  return received;
}

std::optional<DataReport> Wiimote::receive(double max_wait) {
  const double wait = std::clamp(session_->deadline() - clock_(), 0.0, max_wait);
  protocol::Report report;
  const bool received = read(report, wait);
  const double now = clock_();
  std::optional<DataReport> image;
  if (received)
    image = session_->handle(report, now);
  // At the end of a stall what the session waits for may wait behind this report.
  if (!received || wait > 0.0)
    session_->tick(now);
  begins_epoch_ = session_->takeRestart() || begins_epoch_;
  // The exposure clock takes the time of an epoch's first image for its arrival.
  if (backlog_ || (queue_.waited() && begins_epoch_))
    image.reset();
  if (image) {
    delivered_ = true;
    retry_pause_ = kShortestPause;
    if (std::exchange(begins_epoch_, false))
      link_.clock_epoch = epochs_++;
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
    const FactoryCalibration& factory = session_->factory();
    accelerometer_ = factory.accelerometer().value_or(protocol::AccelerometerCalibration());
    link_.error.clear();
    link_.accelerometer_calibrated = factory.accelerometer().has_value();
    link_.accelerometer_unknown = !factory.accelerometerWasRead();
    link_.ir_calibration = factory.ir();
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
