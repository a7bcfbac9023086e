#include "host.h"

#include "system_files.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

namespace wiimote_tracker::list_wiimotes {
namespace {

namespace fs = std::filesystem;
using transport::KernelRemote;

// A Bluetooth adapter has at most this many devices.
constexpr std::size_t kRemotesPerAdapter = 7;

bool holdsOnly(const fs::path& path, const std::string& line) {
  return linesOfFile(path) == std::vector<std::string>{line};
}

std::vector<BluetoothAdapter> readAdapters(const fs::path& root) {
  std::vector<BluetoothAdapter> adapters;
  for (const fs::path& entry : entriesOf(root / "sys/class/bluetooth")) {
    const std::string name = entry.filename().string();
    // Connections are listed, too, as "hci0:256".
    if (name.find(':') == std::string::npos)
      adapters.push_back({name, BluetoothAdapter::Block::kNone});
  }
  for (const fs::path& entry : entriesOf(root / "sys/class/rfkill")) {
    for (BluetoothAdapter& adapter : adapters) {
      if (!holdsOnly(entry / "name", adapter.name))
        continue;
      if (holdsOnly(entry / "hard", "1"))
        adapter.block = BluetoothAdapter::Block::kHard;
      else if (holdsOnly(entry / "soft", "1"))
        adapter.block = BluetoothAdapter::Block::kSoft;
    }
  }
  return adapters;
}

bool hasUdevRule(const fs::path& root) {
  for (const char* folder : {"etc/udev/rules.d", "run/udev/rules.d", "lib/udev/rules.d",
                             "usr/lib/udev/rules.d", "usr/local/lib/udev/rules.d"}) {
    for (const fs::path& file : entriesOf(root / folder)) {
      for (const std::string& rule : linesOfFile(file)) {
        const std::string line = lowerCase(rule);
        if (line.find('#') != 0 && line.find("hidraw") != std::string::npos &&
            line.find("057e:0306") != std::string::npos)
          return true;
      }
    }
  }
  return false;
}

std::optional<bool> readBondedOnly(const fs::path& root) {
  std::optional<bool> bonded_only;
  for (const std::string& setting : linesOfFile(root / "etc/bluetooth/input.conf")) {
    std::string line = lowerCase(setting);
    line.erase(
        std::remove_if(line.begin(), line.end(), [](unsigned char c) { return std::isspace(c); }),
        line.end());
    if (line == "classicbondedonly=true")
      bonded_only = true;
    else if (line == "classicbondedonly=false")
      bonded_only = false;
  }
  return bonded_only;
}

void addBluetoothProblems(const Host& host, std::vector<std::string>* sentences) {
  const bool by_bluetooth = std::any_of(host.remotes.begin(), host.remotes.end(),
                                        [](const KernelRemote& r) { return !r.adapter.empty(); });
  if (host.adapters.empty() && !by_bluetooth)
    sentences->push_back("there is no Bluetooth adapter: plug one in");
  for (const BluetoothAdapter& adapter : host.adapters) {
    if (adapter.block == BluetoothAdapter::Block::kSoft)
      sentences->push_back("the Bluetooth adapter " + adapter.name +
                           " is blocked: run  rfkill unblock bluetooth");
    if (adapter.block == BluetoothAdapter::Block::kHard)
      sentences->push_back("the Bluetooth adapter " + adapter.name +
                           " is switched off by hardware: use the wireless switch or key of this "
                           "computer");
  }
  std::map<std::string, std::size_t> connected;
  for (const KernelRemote& remote : host.remotes) {
    if (!remote.adapter.empty())
      ++connected[remote.adapter];
  }
  for (const auto& adapter : connected) {
    if (adapter.second >= kRemotesPerAdapter)
      sentences->push_back(
          "the Bluetooth adapter " + adapter.first + " has " + std::to_string(adapter.second) +
          " remotes, the most it can take: pair further ones with another adapter");
  }
}

}  // namespace

Host readHost(const std::string& root) {
  const fs::path base = root.empty() ? "/" : root;
  Host host;
  host.remotes = transport::kernelRemotes(root);
  host.adapters = readAdapters(base);
  host.udev_rule = hasUdevRule(base);
  host.bonded_only = readBondedOnly(base);
  return host;
}

std::vector<std::string> problems(const Host& host) {
  std::vector<std::string> sentences;
  addBluetoothProblems(host, &sentences);
  if (!host.udev_rule)
    sentences.push_back(
        "no udev rule lets users open Wii Remotes: run  sudo cp $(rospack find "
        "wiimote_tracker_driver)/udev/60-wiimote-tracker.rules /etc/udev/rules.d/ && sudo udevadm "
        "control --reload  and reconnect the remotes");
  if (host.bonded_only.value_or(false))
    sentences.push_back(
        "ClassicBondedOnly is true in /etc/bluetooth/input.conf, so that remotes paired with 1+2 "
        "are turned away: pair each with its SYNC button");
  return sentences;
}

std::vector<std::string> problems(const KernelRemote& remote) {
  if (remote.path.empty())
    return {
        "the kernel has this remote but made no hidraw node for it: run  sudo modprobe "
        "hid-wiimote  and reconnect the remote"};
  std::vector<std::string> sentences;
  if (remote.address.empty())
    sentences.push_back(
        "this remote does not reveal its Bluetooth address, so it cannot be recognised: connect it "
        "to a Bluetooth adapter of this computer instead of a converter");
  return sentences;
}

std::vector<std::string> notes(const KernelRemote& remote) {
  if (remote.kernel_driver != "wiimote")
    return {};
  return {
      "the kernel's driver hid-wiimote shares this remote, as is usual: if the driver's "
      "diagnostics show gaps, see \"Kernel driver\" in doc/quirks.md of wiimote_tracker_driver"};
}

std::string modelOf(const KernelRemote& remote) {
  return remote.plus ? "Wii Remote Plus (RVL-CNT-01-TR)" : "Wii Remote (RVL-CNT-01)";
}

}  // namespace wiimote_tracker::list_wiimotes
