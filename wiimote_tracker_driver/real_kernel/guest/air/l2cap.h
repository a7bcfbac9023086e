#pragma once

#include "bytes.h"

#include <functional>
#include <map>

namespace wiimote_tracker::real_kernel {

constexpr unsigned kSdpPsm = 0x01;
constexpr unsigned kControlPsm = 0x11;
constexpr unsigned kInterruptPsm = 0x13;

/// The remote's side of the channels of one connection (Bluetooth Core, Vol 3 Part A: L2CAP in
/// basic mode). A PSM names a service; it has one channel at most.
class L2cap {
 public:
  struct Events {
    std::function<void(const Bytes& frame)> send;  ///< A frame for the host.
    std::function<void(unsigned psm)> opened;
    std::function<void(unsigned psm)> closed;  ///< By the host, or refused by it.
    std::function<void(unsigned psm, const Bytes& data)> received;
  };

  explicit L2cap(Events events) : events_(std::move(events)) {}

  /// Handles a frame of the host. @throws std::out_of_range if it is too short.
  void receive(const Bytes& frame);

  /// Asks the host for a channel.
  void open(unsigned psm);

  bool isOpen(unsigned psm) const;

  /// Sends data to the host, if the channel is open.
  void send(unsigned psm, const Bytes& data);

 private:
  struct Channel {
    unsigned psm = 0;
    unsigned hosts_id = 0;
    bool configured_here = false;  ///< The host has accepted our configuration.
    bool configured_there = false;
  };
  using Channels = std::map<unsigned, Channel>;

  Channels::const_iterator channelOf(unsigned psm) const;
  unsigned add(unsigned psm, unsigned hosts_id);
  void signal(std::uint8_t code, std::uint8_t id, const Bytes& content);
  void configure(const Channel& channel);
  void handleSignal(std::uint8_t code, std::uint8_t id, const Bytes& content);
  void acceptChannel(std::uint8_t id, const Bytes& content);
  void handleAnswer(const Bytes& content);
  void configured(unsigned own_id, bool here, std::uint8_t id);
  void close(std::uint8_t id, const Bytes& content);

  const Events events_;
  Channels channels_;  // by our own ids
  unsigned last_id_ = 0x40;
  std::uint8_t last_signal_ = 0;
};

}  // namespace wiimote_tracker::real_kernel
