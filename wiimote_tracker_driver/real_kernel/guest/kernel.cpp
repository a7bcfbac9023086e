#include "kernel.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace wiimote_tracker::real_kernel {
namespace {

namespace fs = std::filesystem;

/// Entries of a folder, in order; none when there is no such folder.
std::vector<fs::path> entries(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    found.push_back(i->path());
  std::sort(found.begin(), found.end());
  return found;
}

std::string withoutError(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// The remote's folder on the HID bus; empty when it is not there.
fs::path hidFolderOf(const std::string& address) {
  for (const fs::path& folder : entries("/sys/bus/hid/devices")) {
    std::ifstream properties(folder / "uevent");
    for (std::string line; std::getline(properties, line);) {
      if (line == "HID_UNIQ=" + address)
        return folder;
    }
  }
  return {};
}

/// The first file of this class of the remote's for which `fits(name)` holds.
template <typename Fits>
fs::path classEntry(const std::string& address, const std::string& name, Fits fits) {
  const fs::path folder = hidFolderOf(address);
  if (folder.empty())
    return {};
  for (const fs::path& entry : entries(folder / name)) {
    if (fits(entry))
      return entry;
  }
  return {};
}

}  // namespace

std::string hidrawOf(const std::string& address) {
  const fs::path entry = classEntry(address, "hidraw", [](const fs::path&) { return true; });
  return entry.empty() ? "" : "/dev/" + entry.filename().string();
}

std::string kernelDriverOf(const std::string& address) {
  std::error_code error;
  const fs::path target = fs::read_symlink(hidFolderOf(address) / "driver", error);
  return target.filename();
}

std::string hidNameOf(const std::string& address) {
  return hidFolderOf(address).filename();
}

std::string sysfsPathOf(const std::string& address) {
  std::error_code error;
  return fs::canonical(hidFolderOf(address), error);
}

std::string adapterOf(const std::string& address) {
  const std::string key = "HID_PHYS=";
  std::ifstream properties(hidFolderOf(address) / "uevent");
  for (std::string line; std::getline(properties, line);) {
    if (line.compare(0, key.size(), key) == 0)
      return line.substr(key.size());
  }
  return "";
}

std::string batteryFileOf(const std::string& address) {
  const fs::path entry = classEntry(address, "power_supply", [](const fs::path&) { return true; });
  return entry.empty() ? "" : (entry / "capacity").string();
}

std::string ledFileOf(const std::string& address, int led) {
  const std::string ending = ":p" + std::to_string(led - 1);
  const fs::path entry = classEntry(address, "leds", [&](const fs::path& path) {
    const std::string name = path.filename();
    return name.size() > ending.size() &&
           name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
  });
  return entry.empty() ? "" : (entry / "brightness").string();
}

std::string inputNodeOf(const std::string& address, const std::string& name) {
  const fs::path input = classEntry(
      address, "input", [&](const fs::path& path) { return withoutError(path / "name") == name; });
  if (input.empty())
    return "";
  for (const fs::path& entry : entries(input)) {
    const std::string node = entry.filename();
    if (node.compare(0, 5, "event") == 0)
      return "/dev/input/" + node;
  }
  return "";
}

std::vector<std::string> inputNodes() {
  std::vector<std::string> nodes;
  for (const fs::path& entry : entries("/dev/input")) {
    if (entry.filename().string().compare(0, 5, "event") == 0)
      nodes.push_back(entry);
  }
  return nodes;
}

std::string readLine(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line))
    throw std::runtime_error("cannot read '" + path + "': " + std::strerror(errno));
  return line;
}

void writeText(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  if (!(file << text << std::flush))
    throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno));
}

}  // namespace wiimote_tracker::real_kernel
