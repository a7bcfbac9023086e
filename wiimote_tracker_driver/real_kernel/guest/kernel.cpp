#include "kernel.h"

#include <glob.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace wiimote_tracker::real_kernel {
namespace {

namespace fs = std::filesystem;

/// The existing paths that match the pattern, in order.
std::vector<std::string> matches(const std::string& pattern) {
  glob_t found{};
  ::glob(pattern.c_str(), 0, nullptr, &found);
  const std::vector<std::string> paths(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  ::globfree(&found);
  return paths;
}

/// The first of them; empty when there is none.
std::string firstMatch(const std::string& pattern) {
  const std::vector<std::string> paths = matches(pattern);
  return paths.empty() ? "" : paths.front();
}

/// Its first line; empty when it cannot be read.
std::string firstLineOf(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// The remote's folder on the HID bus; empty when it is not there.
fs::path hidFolderOf(const std::string& address) {
  for (const fs::path path : matches("/sys/bus/hid/devices/*/uevent")) {
    std::ifstream properties(path);
    for (std::string line; std::getline(properties, line);) {
      if (line == "HID_UNIQ=" + address)
        return path.parent_path();
    }
  }
  return {};
}

}  // namespace

std::string hidrawOf(const std::string& address) {
  const fs::path entry = firstMatch(hidFolderOf(address) / "hidraw/*");
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
  return firstMatch(hidFolderOf(address) / "power_supply/*/capacity");
}

std::string ledFileOf(const std::string& address, int led) {
  return firstMatch(hidFolderOf(address) / ("leds/*:p" + std::to_string(led - 1) + "/brightness"));
}

std::string inputNodeOf(const std::string& address, const std::string& name) {
  for (const fs::path path : matches(hidFolderOf(address) / "input/*/name")) {
    if (firstLineOf(path) == name) {
      const fs::path node = firstMatch(path.parent_path() / "event*");
      return node.empty() ? "" : "/dev/input/" + node.filename().string();
    }
  }
  return "";
}

std::vector<std::string> inputNodes() {
  return matches("/dev/input/event*");
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
