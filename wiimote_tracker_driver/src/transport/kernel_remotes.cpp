#include "transport/kernel_remotes.h"

#include "system_files.h"
#include "transport/transport.h"

#include <wiimote_tracker_msgs/text.h>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <filesystem>
#include <map>

namespace wiimote_tracker::transport {
namespace {

using boost::algorithm::ends_with;
namespace fs = std::filesystem;

/// The KEY=VALUE lines of a uevent file.
std::map<std::string, std::string> valuesOf(const fs::path& path) {
  std::map<std::string, std::string> values;
  for (const std::string& line : linesOfFile(path)) {
    const std::size_t equals = line.find('=');
    if (equals != std::string::npos)
      values[line.substr(0, equals)] = line.substr(equals + 1);
  }
  return values;
}

}  // namespace

std::vector<KernelRemote> kernelRemotes(const std::string& root) {
  std::vector<KernelRemote> remotes;
  for (const fs::path& device : entriesOf(root + "/sys/bus/hid/devices")) {
    auto values = valuesOf(device / "uevent");
    // HID_ID is bus:vendor:product, "0005:0000057E:00000306".
    const std::string id = lowerCase(values["HID_ID"]);
    KernelRemote remote;
    remote.plus = ends_with(id, ":0000057e:00000330");
    if (!remote.plus && !ends_with(id, ":0000057e:00000306"))
      continue;
    // The Wii U Pro Controller and the Balance Board share the ids, but have no camera.
    const std::string& name = values["HID_NAME"];
    if (ends_with(name, "RVL-CNT-01-UC") || ends_with(name, "RVL-WBC-01"))
      continue;
    // For a USB device these are its serial number and a location.
    remote.address = bluetoothAddress(values["HID_UNIQ"]).value_or("");
    remote.adapter = bluetoothAddress(values["HID_PHYS"]).value_or("");
    remote.kernel_driver = values["DRIVER"];
    const std::vector<fs::path> nodes = entriesOf(device / "hidraw");
    if (!nodes.empty())
      remote.path = "/dev/" + nodes.front().filename().string();
    remotes.push_back(remote);
  }
  // hidraw10 comes after hidraw9.
  std::sort(remotes.begin(), remotes.end(), [](const KernelRemote& a, const KernelRemote& b) {
    return a.path.size() != b.path.size() ? a.path.size() < b.path.size() : a.path < b.path;
  });
  return remotes;
}

}  // namespace wiimote_tracker::transport
