#pragma once

#include "l2cap.h"
#include "scene.h"
#include "timers.h"
#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <functional>
#include <optional>
#include <string>

namespace wiimote_tracker::real_kernel {

constexpr std::uint8_t kClosedByRemote = 0x13;  ///< Reason of a disconnection (HCI error code).

/// What the user does to a remote. Other buttons make it call the computer it is paired with.
enum class Press { kSync, kOneAndTwo, kOther };

/// A Wii Remote in the air: found, paired with a PIN, connected, and used over its HID channels,
/// behind which is the device model of virtual_wiimote.
class Remote {
 public:
  /// A connection as the remote uses it.
  struct Link {
    Address host{};
    std::function<void(const Bytes& frame)> send;         ///< L2CAP frames.
    std::function<void(std::uint8_t reason)> disconnect;  ///< By the remote.
  };

  /// `plus`: an RVL-CNT-01-TR.
  Remote(const std::string& address, bool plus, Scene& scene, Timers& timers);

  const Address& address() const { return address_; }
  const std::string& name() const { return name_; }
  Bytes classOfDevice() const;

  /// Wakes the remote up. For 20 s it answers those who search, unless this is kOther.
  void press(Press press);

  /// Whether it answers searches and calls now.
  bool answers() const;

  /// The computer that kOther calls; nothing if there is none.
  std::optional<Address> bondedTo() const { return bonded_to_; }

  bool connected() const { return link_.has_value(); }
  void connect(const Link& link);
  void disconnected();
  /// Ends the connection, if there is one, for this reason (HCI error code).
  void lose(std::uint8_t reason);
  /// Opens its HID channels itself, after it has called the host.
  void openHid() { l2cap_->open(kControlPsm); }
  /// A frame of the host.
  void receive(const Bytes& frame) { l2cap_->receive(frame); }

  /// Whether this is the PIN: after SYNC the host's address, after 1+2 the remote's own. The right
  /// one makes `key`, which the remote keeps only after SYNC.
  bool accepts(const Bytes& pin, const Bytes& key);
  bool knows(const Bytes& key) const { return !key_.empty() && key == key_; }

 private:
  void opened(unsigned psm);
  void closed(unsigned psm);
  void received(unsigned psm, const Bytes& data);
  void handleOutput(const Bytes& report);
  void sendInput(const Bytes& report);
  void sample(double time);

  const Address address_;
  const bool plus_;
  const std::string name_;
  Scene& scene_;
  Timers& timers_;
  virtual_wiimote::Device device_;

  Press pressed_ = Press::kOther;
  double answers_until_ = 0.0;  // [s]
  std::optional<Address> bonded_to_;
  Bytes key_;

  std::optional<Link> link_;
  std::optional<L2cap> l2cap_;
  int connections_ = 0;
};

}  // namespace wiimote_tracker::real_kernel
