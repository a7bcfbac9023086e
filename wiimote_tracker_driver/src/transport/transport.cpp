#include "transport/transport.h"

#include "transport/hidraw_transport.h"
#include "transport/socket_transport.h"

#include <wiimote_tracker_msgs/text.h>

#include <sys/un.h>

#include <regex>
#include <utility>

namespace wiimote_tracker::transport {
namespace {

/// What follows a prefix; empty: the text does not begin with it, or ends there.
std::string after(const std::string& prefix, const std::string& text) {
  return text.compare(0, prefix.size(), prefix) == 0 ? text.substr(prefix.size()) : "";
}

}  // namespace

std::optional<std::string> bluetoothAddress(const std::string& text) {
  static const std::regex pattern("([0-9A-Fa-f]{2}:){5}[0-9A-Fa-f]{2}");
  return std::regex_match(text, pattern) ? std::make_optional(lowerCase(text)) : std::nullopt;
}

DeviceName parseDeviceName(const std::string& text) {
  if (text.empty())
    return {DeviceName::Kind::kAny, ""};
  if (const auto address = bluetoothAddress(text))
    return {DeviceName::Kind::kAddress, *address};
  if (std::regex_match(text, std::regex("/dev/hidraw[0-9]+")))
    return {DeviceName::Kind::kPath, text};
  if (const std::string path = after("virtual:", text); !path.empty()) {
    const std::size_t longest = sizeof(sockaddr_un::sun_path) - 1;
    if (path.size() > longest)
      throw BadDeviceName("the socket path in device '" + text +
                          "' is too long: use one of at most " + std::to_string(longest) +
                          " characters");
    return {DeviceName::Kind::kVirtual, path};
  }
  if (const std::string file = after("replay:", text); !file.empty())
    return {DeviceName::Kind::kReplay, file};
  throw BadDeviceName("device '" + text +
                      "' must be empty (the first free Wii Remote), a Bluetooth address such as "
                      "00:1f:32:12:34:56, a path such as /dev/hidraw0, virtual:SOCKET_PATH, or "
                      "replay:FILE");
}

std::unique_ptr<Transport> open(const DeviceName& name) {
  return opener(name)(false);
}

Opener opener(const DeviceName& name, std::function<std::vector<KernelRemote>()> list) {
  return [name, list = std::move(list), last = std::string()](bool delivered) mutable {
    if (name.kind == DeviceName::Kind::kVirtual)
      return openSocket(name.value);
    if (name.kind == DeviceName::Kind::kReplay)
      throw BadDeviceName("the recording " + name.value +
                          " is no remote for this program: give it to the driver's node");
    std::vector<KernelRemote> remotes = list();
    orderAfter(last, delivered, &remotes);
    auto transport = openHidraw(name, remotes);
    last = transport->remote().description;
    return transport;
  };
}

}  // namespace wiimote_tracker::transport
