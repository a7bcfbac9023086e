#include "transport/transport.h"

#include "transport/hidraw_transport.h"
#include "transport/socket_transport.h"

#include <wiimote_tracker_msgs/text.h>

#include <sys/un.h>

#include <algorithm>
#include <cctype>

namespace wiimote_tracker::transport {
namespace {

constexpr char kVirtualPrefix[] = "virtual:";
constexpr char kReplayPrefix[] = "replay:";

bool startsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

bool isAddress(const std::string& text) {
  if (text.size() != 17)
    return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (i % 3 == 2 ? c != ':' : std::isxdigit(c) == 0)
      return false;
  }
  return true;
}

bool isHidrawPath(const std::string& text) {
  static const std::string prefix = "/dev/hidraw";
  return startsWith(text, prefix) && text.size() > prefix.size() &&
         std::all_of(text.begin() + static_cast<std::ptrdiff_t>(prefix.size()), text.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

DeviceName parseDeviceName(const std::string& text) {
  if (text.empty())
    return {DeviceName::Kind::kAny, ""};
  if (isAddress(text))
    return {DeviceName::Kind::kAddress, lowerCase(text)};
  if (isHidrawPath(text))
    return {DeviceName::Kind::kPath, text};
  const std::size_t prefix = sizeof(kVirtualPrefix) - 1;
  if (startsWith(text, kVirtualPrefix) && text.size() > prefix) {
    const std::size_t longest = sizeof(sockaddr_un::sun_path) - 1;
    if (text.size() - prefix > longest)
      throw BadDeviceName("the socket path in device '" + text +
                          "' is too long: use one of at most " + std::to_string(longest) +
                          " characters");
    return {DeviceName::Kind::kVirtual, text.substr(prefix)};
  }
  const std::size_t replay_prefix = sizeof(kReplayPrefix) - 1;
  if (startsWith(text, kReplayPrefix) && text.size() > replay_prefix)
    return {DeviceName::Kind::kReplay, text.substr(replay_prefix)};
  throw BadDeviceName("device '" + text +
                      "' must be empty (the first free Wii Remote), a Bluetooth address such as "
                      "00:1f:32:12:34:56, a path such as /dev/hidraw0, virtual:SOCKET_PATH, or "
                      "replay:FILE");
}

std::unique_ptr<Transport> open(const DeviceName& name, const std::string& last) {
  switch (name.kind) {
    case DeviceName::Kind::kVirtual:
      return openSocket(name.value);
    case DeviceName::Kind::kReplay:
      throw BadDeviceName("the recording " + name.value +
                          " is no remote for this program: give it to the driver's node");
    default:
      return openHidraw(name, last);
  }
}

std::function<std::unique_ptr<Transport>()> opener(const DeviceName& name) {
  return [name, last = std::string()]() mutable {
    auto transport = open(name, last);
    last = transport->description();
    return transport;
  };
}

}  // namespace wiimote_tracker::transport
