#pragma once

#include "bytes.h"
#include "file_descriptor.h"
#include "remote.h"
#include "timers.h"

#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>

namespace wiimote_tracker::real_kernel {

/// A Bluetooth adapter of this computer, without radio: a controller of basic rate behind
/// /dev/vhci (Bluetooth Core, Vol 4 Part E: HCI), as far as Linux and BlueZ use it with remotes.
class Adapter {
 public:
  /// Plugs it in. `remotes`: all in the air. @throws std::runtime_error without /dev/vhci.
  Adapter(const std::string& address, std::deque<Remote>& remotes, Timers& timers);

  int fd() const { return vhci_.get(); }
  const Address& address() const { return address_; }

  /// Handles a packet of the kernel. @throws std::out_of_range if it is too short.
  void handle(const Bytes& packet);

  /// A remote calls this computer. @returns whether it listens.
  bool call(Remote& remote);

  /// The remote's link is lost, or closed for another reason.
  void drop(Remote& remote, std::uint8_t reason);

 private:
  void handleCommand(unsigned code, const Bytes& in);
  bool handleInformation(unsigned code);
  bool handleSearch(unsigned code, const Bytes& in);
  bool handleConnection(unsigned code, const Bytes& in);
  bool handlePairing(unsigned code, const Bytes& in);
  bool handleLink(unsigned code, const Bytes& in);
  void handleData(const Bytes& packet);

  void search(double end, int search_number);
  void connect(Remote& remote, bool by_host);
  Remote* remoteAt(const Bytes& in);
  Remote* remoteOf(unsigned handle);
  unsigned handleOf(const Remote& remote) const;

  void send(const Bytes& packet) const;
  void event(std::uint8_t code, const Bytes& content) const;
  void complete(unsigned command, const Bytes& result = {}) const;
  void accept(unsigned command) const;
  void eventAfter(double seconds, std::uint8_t code, const Bytes& content);

  const Address address_;
  std::deque<Remote>& remotes_;
  Timers& timers_;
  FileDescriptor vhci_;
  std::map<unsigned, Remote*> connections_;  // by handle
  int searches_ = 0;                         // a search ends when this changes
  bool strength_in_results_ = false;
  bool answers_calls_ = false;
  std::set<const Remote*> found_;  // by this search
  std::uint8_t keys_ = 0;
};

}  // namespace wiimote_tracker::real_kernel
