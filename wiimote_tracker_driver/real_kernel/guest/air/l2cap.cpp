#include "l2cap.h"

#include <algorithm>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr unsigned kSignallingId = 1;
constexpr unsigned kMtu = 672;

// Codes of the signalling channel.
constexpr std::uint8_t kConnect = 2;
constexpr std::uint8_t kConnectAnswer = 3;
constexpr std::uint8_t kConfigure = 4;
constexpr std::uint8_t kConfigureAnswer = 5;
constexpr std::uint8_t kDisconnect = 6;
constexpr std::uint8_t kDisconnectAnswer = 7;
constexpr std::uint8_t kEcho = 8;
constexpr std::uint8_t kEchoAnswer = 9;
constexpr std::uint8_t kInformation = 10;
constexpr std::uint8_t kInformationAnswer = 11;

Bytes frameOf(unsigned channel, const Bytes& content) {
  return join(le16(static_cast<unsigned>(content.size())), le16(channel), content);
}

}  // namespace

void L2cap::receive(const Bytes& frame) {
  const unsigned id = le16At(frame, 2);
  const Bytes content = part(frame, 4, le16At(frame, 0));
  if (id != kSignallingId) {
    const auto channel = channels_.find(id);
    if (channel != channels_.end())
      events_.received(channel->second.psm, content);
    return;
  }
  for (std::size_t at = 0; at + 4 <= content.size();) {
    const std::size_t size = le16At(content, at + 2);
    handleSignal(content[at], content[at + 1], part(content, at + 4, size));
    at += 4 + size;
  }
}

void L2cap::open(unsigned psm) {
  const unsigned id = add(psm, 0);
  signal(kConnect, ++last_signal_, join(le16(psm), le16(id)));
}

L2cap::Channels::const_iterator L2cap::channelOf(unsigned psm) const {
  return std::find_if(channels_.begin(), channels_.end(),
                      [psm](const auto& entry) { return entry.second.psm == psm; });
}

bool L2cap::isOpen(unsigned psm) const {
  const auto channel = channelOf(psm);
  return channel != channels_.end() && channel->second.configured_here &&
         channel->second.configured_there;
}

void L2cap::send(unsigned psm, const Bytes& data) {
  if (isOpen(psm))
    events_.send(frameOf(channelOf(psm)->second.hosts_id, data));
}

unsigned L2cap::add(unsigned psm, unsigned hosts_id) {
  Channel channel;
  channel.psm = psm;
  channel.hosts_id = hosts_id;
  channels_[++last_id_] = channel;
  return last_id_;
}

void L2cap::signal(std::uint8_t code, std::uint8_t id, const Bytes& content) {
  events_.send(frameOf(
      kSignallingId, join(Bytes{code, id}, le16(static_cast<unsigned>(content.size())), content)));
}

void L2cap::configure(const Channel& channel) {
  constexpr std::uint8_t kMtuOption = 1;
  signal(kConfigure, ++last_signal_,
         join(le16(channel.hosts_id), le16(0), Bytes{kMtuOption, 2}, le16(kMtu)));
}

void L2cap::handleSignal(std::uint8_t code, std::uint8_t id, const Bytes& content) {
  switch (code) {
    case kConnect:
      return acceptChannel(id, content);
    case kConnectAnswer:
      return handleAnswer(content);
    case kConfigure:
      return configured(le16At(content, 0), false, id);
    case kConfigureAnswer:
      return configured(le16At(content, 0), true, id);
    case kDisconnect:
      return close(id, content);
    case kEcho:
      return signal(kEchoAnswer, id, content);
    case kInformation:  // nothing beyond the basics is supported
      return signal(kInformationAnswer, id, join(part(content, 0, 2), le16(1)));
    default:
      return;
  }
}

void L2cap::acceptChannel(std::uint8_t id, const Bytes& content) {
  const unsigned psm = le16At(content, 0);
  const unsigned hosts_id = le16At(content, 2);
  if (psm != kSdpPsm && psm != kControlPsm && psm != kInterruptPsm) {
    constexpr unsigned kNotSupported = 2;
    signal(kConnectAnswer, id, join(le16(0), le16(hosts_id), le16(kNotSupported), le16(0)));
    return;
  }
  const unsigned own_id = add(psm, hosts_id);
  signal(kConnectAnswer, id, join(le16(own_id), le16(hosts_id), le16(0), le16(0)));
  configure(channels_[own_id]);
}

void L2cap::handleAnswer(const Bytes& content) {
  constexpr unsigned kSuccess = 0;
  constexpr unsigned kPending = 1;
  const auto channel = channels_.find(le16At(content, 2));
  const unsigned result = le16At(content, 4);
  if (channel == channels_.end() || result == kPending)
    return;
  if (result == kSuccess) {
    channel->second.hosts_id = le16At(content, 0);
    configure(channel->second);
    return;
  }
  const unsigned psm = channel->second.psm;
  channels_.erase(channel);
  events_.closed(psm);
}

void L2cap::configured(unsigned own_id, bool here, std::uint8_t id) {
  const auto found = channels_.find(own_id);
  if (found == channels_.end())
    return;
  Channel& channel = found->second;
  const bool was_open = channel.configured_here && channel.configured_there;
  (here ? channel.configured_here : channel.configured_there) = true;
  if (!here)
    signal(kConfigureAnswer, id, join(le16(channel.hosts_id), le16(0), le16(0)));
  if (!was_open && channel.configured_here && channel.configured_there)
    events_.opened(channel.psm);
}

void L2cap::close(std::uint8_t id, const Bytes& content) {
  const auto channel = channels_.find(le16At(content, 0));
  signal(kDisconnectAnswer, id, content);
  if (channel == channels_.end())
    return;
  const unsigned psm = channel->second.psm;
  channels_.erase(channel);
  events_.closed(psm);
}

}  // namespace wiimote_tracker::real_kernel
