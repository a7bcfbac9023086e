#include "adapter.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace wiimote_tracker::real_kernel {
namespace {

// Types of packets.
constexpr std::uint8_t kCommand = 1;
constexpr std::uint8_t kData = 2;
constexpr std::uint8_t kEvent = 4;

// Events.
constexpr std::uint8_t kInquiryComplete = 0x01;
constexpr std::uint8_t kInquiryResult = 0x02;
constexpr std::uint8_t kConnectionComplete = 0x03;
constexpr std::uint8_t kConnectionRequest = 0x04;
constexpr std::uint8_t kDisconnectionComplete = 0x05;
constexpr std::uint8_t kAuthenticationComplete = 0x06;
constexpr std::uint8_t kRemoteName = 0x07;
constexpr std::uint8_t kEncryptionChange = 0x08;
constexpr std::uint8_t kRemoteFeatures = 0x0b;
constexpr std::uint8_t kRemoteVersion = 0x0c;
constexpr std::uint8_t kCommandComplete = 0x0e;
constexpr std::uint8_t kCommandStatus = 0x0f;
constexpr std::uint8_t kPacketsSent = 0x13;
constexpr std::uint8_t kPinRequest = 0x16;
constexpr std::uint8_t kLinkKeyRequest = 0x17;
constexpr std::uint8_t kLinkKey = 0x18;
constexpr std::uint8_t kInquiryResultWithStrength = 0x22;

// Status codes.
constexpr std::uint8_t kPageTimeout = 0x04;
constexpr std::uint8_t kAuthenticationFailed = 0x05;
constexpr std::uint8_t kPinMissing = 0x06;
constexpr std::uint8_t kByHost = 0x16;

constexpr unsigned kFirstHandle = 0x40;
constexpr double kPageTime = 0.08;         // [s] Until a remote that listens has answered.
constexpr double kPageTimeoutTime = 5.12;  // [s]
constexpr double kSearchInterval = 0.15;   // [s]
constexpr double kInquiryLength = 1.28;    // [s] Unit of the host's limit.
constexpr double kRoundTrip = 0.01;        // [s] Of the link managers.

Bytes bytesOf(const Address& address) {
  return Bytes(address.begin(), address.end());
}

/// Of a fixed size, filled up with zeros.
Bytes padded(const std::string& text, std::size_t size) {
  Bytes bytes(text.begin(), text.end());
  bytes.resize(size, 0);
  return bytes;
}

}  // namespace

Adapter::Adapter(const std::string& address, std::deque<Remote>& remotes, Timers& timers)
    : address_(addressFrom(address)),
      remotes_(remotes),
      timers_(timers),
      vhci_(::open("/dev/vhci", O_RDWR | O_CLOEXEC)) {
  if (!vhci_.open())
    throw std::runtime_error(std::string("cannot open /dev/vhci: ") + std::strerror(errno));
  send({0xff, 0x00});  // creates a primary controller
}

void Adapter::handle(const Bytes& packet) {
  if (packet.at(0) == kCommand)
    handleCommand(le16At(packet, 1), part(packet, 4));
  else if (packet[0] == kData)
    handleData(packet);
}

bool Adapter::call(Remote& remote) {
  if (answers_calls_)
    event(kConnectionRequest, join(remote.address(), remote.classOfDevice(), Bytes{1}));
  return answers_calls_;
}

void Adapter::drop(Remote& remote, std::uint8_t reason) {
  const unsigned handle = handleOf(remote);
  connections_.erase(handle);
  remote.disconnected();
  event(kDisconnectionComplete, join(Bytes{0}, le16(handle), Bytes{reason}));
}

void Adapter::handleCommand(unsigned code, const Bytes& in) {
  const bool known = handleInformation(code) || handleSearch(code, in) ||
                     handleConnection(code, in) || handlePairing(code, in) || handleLink(code, in);
  if (!known)  // settings, which are accepted and have no effect; the host reads at most 8 bytes
    complete(code, Bytes(code >> 10 == 5 ? 8 : 0));
}

/// What the controller says about itself.
bool Adapter::handleInformation(unsigned code) {
  // Packets of three and five slots, encryption, role switch, sniff mode; signal strengths in
  // results of searches.
  static const Bytes kFeatures{0xa7, 0x01, 0x00, 0x40, 0, 0, 0, 0};
  static const std::map<unsigned, Bytes> kAnswers{
      {0x1001, {3, 0, 0, 3, 0x3f, 0, 0, 0}},                      // version: 2.0
      {0x1002, Bytes(64)},                                        // commands
      {0x1003, kFeatures},                                        //
      {0x1005, join(le16(1021), Bytes{64}, le16(10), le16(10))},  // buffers
      {0x0c14, padded("simulated", 248)},                         // name
      {0x0c23, {0, 0, 0}},                                        // class of device
      {0x0c25, {0x60, 0}},                                        // voice
      {0x0c38, {1}},                                              // number of access codes
      {0x0c39, {1, 0x33, 0x8b, 0x9e}},                            // access codes
      {0x0c1b, join(le16(0x800), le16(0x12))},                    // scan activity
      {0x0c46, {0}},                                              // page scan mode
      {0x0c12, {0, 0}},                                           // deleted keys
  };
  if (code == 0x1009) {
    complete(code, bytesOf(address_));
    return true;
  }
  const auto answer = kAnswers.find(code);
  if (answer == kAnswers.end())
    return false;
  complete(code, answer->second);
  return true;
}

bool Adapter::handleSearch(unsigned code, const Bytes& in) {
  switch (code) {
    case 0x0401:  // inquiry
      accept(code);
      found_.clear();
      search(now() + kInquiryLength * in.at(3), ++searches_);
      return true;
    case 0x0402:  // cancel
      ++searches_;
      complete(code);
      return true;
    case 0x0c45:  // inquiry mode
      strength_in_results_ = in.at(0) != 0;
      complete(code);
      return true;
    case 0x0c1a:  // scan enable
      answers_calls_ = (in.at(0) & 2) != 0;
      complete(code);
      return true;
    case 0x0419: {  // remote name request
      accept(code);
      const Remote* remote = remoteAt(in);
      const bool answers = remote && (remote->connected() || remote->answers());
      eventAfter(6 * kRoundTrip, kRemoteName,
                 join(Bytes{answers ? std::uint8_t{0} : kPageTimeout}, part(in, 0, 6),
                      padded(answers ? remote->name() : "", 248)));
      return true;
    }
    default:
      return false;
  }
}

/// Looks for remotes until `end` [s], unless another search begins.
void Adapter::search(double end, int search_number) {
  timers_.after(kSearchInterval, [=] {
    if (search_number != searches_)
      return;
    for (const Remote& remote : remotes_) {
      if (!remote.answers() || !found_.insert(&remote).second)
        continue;
      const Bytes clock_offset{0x12, 0x34};
      const Bytes strength{0xc8};
      if (strength_in_results_)
        event(kInquiryResultWithStrength, join(Bytes{1}, remote.address(), Bytes{1, 0},
                                               remote.classOfDevice(), clock_offset, strength));
      else
        event(kInquiryResult, join(Bytes{1}, remote.address(), Bytes{1, 0, 0},
                                   remote.classOfDevice(), clock_offset));
    }
    if (now() < end)
      search(end, search_number);
    else
      event(kInquiryComplete, {0});
  });
}

bool Adapter::handleConnection(unsigned code, const Bytes& in) {
  Remote* remote = remoteAt(in);
  const auto failed = [&](std::uint8_t status) {
    return join(Bytes{status, 0, 0}, part(in, 0, 6), Bytes{1, 0});
  };
  switch (code) {
    case 0x0405:  // create
      accept(code);
      if (remote && remote->answers())
        timers_.after(kPageTime, [this, remote] { connect(*remote, true); });
      else
        eventAfter(kPageTimeoutTime, kConnectionComplete, failed(kPageTimeout));
      return true;
    case 0x0408:  // cancel
      complete(code, part(in, 0, 6));
      event(kConnectionComplete, failed(0x02));
      return true;
    case 0x0409:  // accept
      accept(code);
      timers_.after(3 * kRoundTrip, [this, remote] { connect(*remote, false); });
      return true;
    case 0x040a:  // reject
      accept(code);
      event(kConnectionComplete, failed(in.at(6)));
      return true;
    case 0x0406:  // disconnect
      accept(code);
      remote = remoteOf(le16At(in, 0));
      if (remote)
        timers_.after(2 * kRoundTrip, [this, remote] {
          if (remote->connected())
            drop(*remote, kByHost);
        });
      return true;
    default:
      return false;
  }
}

void Adapter::connect(Remote& remote, bool by_host) {
  const auto index =
      static_cast<unsigned>(std::find_if(remotes_.begin(), remotes_.end(),
                                         [&](const Remote& other) { return &other == &remote; }) -
                            remotes_.begin());
  const unsigned handle = kFirstHandle + index;
  connections_[handle] = &remote;
  Remote::Link link;
  link.host = address_;
  link.send = [this, handle](const Bytes& frame) {
    constexpr unsigned kWhole = 0x2000;
    send(join(Bytes{kData}, le16(handle | kWhole), le16(static_cast<unsigned>(frame.size())),
              frame));
  };
  link.disconnect = [this, &remote](std::uint8_t reason) { drop(remote, reason); };
  remote.connect(link);
  event(kConnectionComplete, join(Bytes{0}, le16(handle), remote.address(), Bytes{1, 0}));
  if (!by_host)
    timers_.after(6 * kRoundTrip, [&remote] {
      if (remote.connected())
        remote.openHid();
    });
}

bool Adapter::handlePairing(unsigned code, const Bytes& in) {
  if (code == 0x0411) {  // authentication requested
    accept(code);
    if (const Remote* connected = remoteOf(le16At(in, 0)))
      eventAfter(kRoundTrip, kLinkKeyRequest, bytesOf(connected->address()));
    return true;
  }
  if (code < 0x040b || code > 0x040e)
    return false;
  complete(code, part(in, 0, 6));
  Remote* remote = remoteAt(in);
  if (!remote || !remote->connected())
    return true;
  const auto authenticated = [&](std::uint8_t status) {
    eventAfter(2 * kRoundTrip, kAuthenticationComplete,
               join(Bytes{status}, le16(handleOf(*remote))));
  };
  if (code == 0x040b) {  // link key
    authenticated(remote->knows(part(in, 6)) ? 0 : kAuthenticationFailed);
  } else if (code == 0x040c) {  // no link key
    eventAfter(kRoundTrip, kPinRequest, bytesOf(remote->address()));
  } else if (code == 0x040e) {  // no PIN
    authenticated(kPinMissing);
  } else if (const Bytes key(16, ++keys_); remote->accepts(part(in, 7, in.at(6)), key)) {
    eventAfter(kRoundTrip, kLinkKey, join(remote->address(), key, Bytes{0}));
    authenticated(0);
  } else {
    authenticated(kAuthenticationFailed);
    timers_.after(10 * kRoundTrip, [this, remote] {
      if (remote->connected())
        drop(*remote, kClosedByRemote);
    });
  }
  return true;
}

/// About an existing connection.
bool Adapter::handleLink(unsigned code, const Bytes& in) {
  const Bytes handle = part(in, 0, 2);
  switch (code) {
    case 0x041b:  // remote features
      accept(code);
      eventAfter(kRoundTrip, kRemoteFeatures,
                 join(Bytes{0}, handle, Bytes{0xbc, 0x02, 0x04, 0x38, 0x08, 0, 0, 0}));
      return true;
    case 0x041d:  // remote version: Broadcom's, as in a remote
      accept(code);
      eventAfter(kRoundTrip, kRemoteVersion, join(Bytes{0}, handle, Bytes{2, 15, 0, 0, 0}));
      return true;
    case 0x0413:  // encryption
      accept(code);
      eventAfter(kRoundTrip, kEncryptionChange, join(Bytes{0}, handle, Bytes{in.at(2)}));
      return true;
    case 0x0803:  // sniff mode, which the simulated link does not need
    case 0x0804:
    case 0x080b:
      accept(code);
      return true;
    case 0x080d:  // link policy
    case 0x1405:  // signal strength
      complete(code, join(handle, Bytes{0}));
      return true;
    default:
      return false;
  }
}

void Adapter::handleData(const Bytes& packet) {
  const unsigned handle = le16At(packet, 1) & 0x0fff;
  event(kPacketsSent, join(Bytes{1}, le16(handle), le16(1)));
  if (Remote* remote = remoteOf(handle))
    remote->receive(part(packet, 5));
}

Remote* Adapter::remoteAt(const Bytes& in) {
  const auto found = std::find_if(remotes_.begin(), remotes_.end(), [&](const Remote& remote) {
    return bytesOf(remote.address()) == part(in, 0, 6);
  });
  return found == remotes_.end() ? nullptr : &*found;
}

Remote* Adapter::remoteOf(unsigned handle) {
  const auto found = connections_.find(handle);
  return found == connections_.end() ? nullptr : found->second;
}

unsigned Adapter::handleOf(const Remote& remote) const {
  const auto found =
      std::find_if(connections_.begin(), connections_.end(),
                   [&](const auto& connection) { return connection.second == &remote; });
  return found == connections_.end() ? 0 : found->first;
}

// The kernel may have closed the adapter meanwhile: then nobody waits for the packet.
void Adapter::send(const Bytes& packet) const {
  if (::write(vhci_.get(), packet.data(), packet.size()) < 0 && errno != EINVAL)
    std::perror("vhci");
}

void Adapter::event(std::uint8_t code, const Bytes& content) const {
  send(join(Bytes{kEvent, code, static_cast<std::uint8_t>(content.size())}, content));
}

void Adapter::eventAfter(double seconds, std::uint8_t code, const Bytes& content) {
  timers_.after(seconds, [=] { event(code, content); });
}

void Adapter::complete(unsigned command, const Bytes& result) const {
  event(kCommandComplete, join(Bytes{1}, le16(command), Bytes{0}, result));
}

void Adapter::accept(unsigned command) const {
  event(kCommandStatus, join(Bytes{0, 1}, le16(command)));
}

}  // namespace wiimote_tracker::real_kernel
