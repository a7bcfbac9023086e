#include "remote.h"

#include "sdp.h"

namespace wiimote_tracker::real_kernel {
namespace {

constexpr double kAnswers = 20.0;         // [s] After SYNC or 1+2.
constexpr double kOutputLatency = 0.012;  // [s]
constexpr double kSamplePeriod = 0.01;    // [s]
constexpr double kGoodbye = 0.2;          // [s] From the last channel to the end of the connection.

constexpr unsigned kRemoteProduct = 0x0306;
constexpr unsigned kPlusProduct = 0x0330;

// First byte of HID packets.
constexpr std::uint8_t kHandshakeSuccess = 0x00;
constexpr std::uint8_t kSetOutputReport = 0x52;
constexpr std::uint8_t kInput = 0xa1;
constexpr std::uint8_t kOutput = 0xa2;

virtual_wiimote::Device::Options deviceOptions(bool plus) {
  virtual_wiimote::Device::Options options;
  options.motion_plus = plus;
  return options;
}

}  // namespace

Remote::Remote(const std::string& address, bool plus, Scene& scene, Timers& timers)
    : address_(addressFrom(address)),
      plus_(plus),
      name_(plus ? "Nintendo RVL-CNT-01-TR" : "Nintendo RVL-CNT-01"),
      scene_(scene),
      timers_(timers),
      device_(deviceOptions(plus)) {}

Bytes Remote::classOfDevice() const {
  return plus_ ? Bytes{0x08, 0x05, 0x00} : Bytes{0x04, 0x25, 0x00};
}

void Remote::press(Press press) {
  if (press != Press::kOther)
    lose(kClosedByRemote);
  pressed_ = press;
  answers_until_ = press == Press::kOther ? 0.0 : now() + kAnswers;
  if (press == Press::kSync)
    key_.clear();
}

bool Remote::answers() const {
  return !link_ && now() < answers_until_;
}

void Remote::connect(const Link& link) {
  ++connections_;
  link_ = link;
  l2cap_.emplace(L2cap::Events{link.send, [this](unsigned psm) { opened(psm); },
                               [this](unsigned psm) { closed(psm); },
                               [this](unsigned psm, const Bytes& data) { received(psm, data); }});
}

void Remote::lose(std::uint8_t reason) {
  if (!link_)
    return;
  const auto disconnect = link_->disconnect;  // outlives the link
  disconnect(reason);
}

void Remote::disconnected() {
  l2cap_.reset();
  link_.reset();
  device_.powerCycle();
}

bool Remote::accepts(const Bytes& pin, const Bytes& key) {
  const Address& expected_pin = pressed_ == Press::kSync ? link_->host : address_;
  if (pin != Bytes(expected_pin.begin(), expected_pin.end()))
    return false;
  if (pressed_ == Press::kSync) {
    bonded_to_ = link_->host;
    key_ = key;
  }
  return true;
}

void Remote::opened(unsigned psm) {
  if (psm == kControlPsm && bonded_to_ && pressed_ == Press::kOther)
    l2cap_->open(kInterruptPsm);
  if (psm == kInterruptPsm)
    sample(now());
}

void Remote::closed(unsigned psm) {
  if (psm == kSdpPsm)
    return;
  timers_.after(kGoodbye, [this, connection = connections_] {
    if (link_ && connection == connections_ && !l2cap_->isOpen(kControlPsm) &&
        !l2cap_->isOpen(kInterruptPsm))
      lose(kClosedByRemote);
  });
}

void Remote::received(unsigned psm, const Bytes& data) {
  if (data.empty())
    return;
  const Bytes content = part(data, 1);
  if (psm == kSdpPsm) {
    l2cap_->send(psm, answerSdp(data, name_, plus_ ? kPlusProduct : kRemoteProduct));
  } else if (psm == kInterruptPsm && data[0] == kOutput) {
    handleOutput(content);
  } else if (psm == kControlPsm && data[0] == kSetOutputReport && !content.empty()) {
    l2cap_->send(psm, {kHandshakeSuccess});
    if (plus_)  // it refuses output on the control channel
      sendInput({0x22, 0, 0, content[0], 2});
    else
      handleOutput(content);
  }
}

void Remote::handleOutput(const Bytes& report) {
  timers_.after(kOutputLatency, [this, report, connection = connections_] {
    if (!link_ || connection != connections_)
      return;
    for (const Bytes& answer : device_.handleOutput(report))
      sendInput(answer);
  });
}

void Remote::sendInput(const Bytes& report) {
  l2cap_->send(kInterruptPsm, join(Bytes{kInput}, report));
}

/// Samples the camera at `time` [s], and from then on until the connection ends.
void Remote::sample(double time) {
  timers_.at(time, [this, time, connection = connections_] {
    if (!link_ || connection != connections_)
      return;
    virtual_wiimote::Senses senses;
    senses.lights = scene_.next();
    if (const auto report = device_.sample(senses))
      sendInput(*report);
    sample(time + kSamplePeriod);
  });
}

}  // namespace wiimote_tracker::real_kernel
