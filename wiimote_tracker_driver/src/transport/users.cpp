#include "transport/users.h"

#include "system_files.h"
#include "transport/transport.h"

#include <wiimote_tracker_msgs/text.h>

#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace wiimote_tracker::transport {
namespace {

std::string procPath(pid_t process, const std::string& name) {
  return "/proc/" + std::to_string(process) + "/" + name;
}

/// The strings of a file such as /proc/PID/cmdline, each of which ends with a zero.
std::vector<std::string> zeroSeparated(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::string> strings;
  for (std::string string; std::getline(file, string, '\0');)
    strings.push_back(string);
  return strings;
}

/// What follows `prefix` in the first string that begins with it.
std::string valueOf(const std::string& prefix, const std::vector<std::string>& strings) {
  for (const std::string& string : strings) {
    if (string.compare(0, prefix.size(), prefix) == 0)
      return string.substr(prefix.size());
  }
  return "";
}

/// Of a node that was given its name on the command line, as roslaunch does.
std::string rosNodeName(pid_t process, const std::vector<std::string>& arguments) {
  const std::string name = valueOf("__name:=", arguments);
  if (name.empty())
    return "";
  std::string space = valueOf("__ns:=", arguments);
  if (space.empty())
    space = valueOf("ROS_NAMESPACE=", zeroSeparated(procPath(process, "environ")));
  if (space.empty() || space.front() != '/')
    space.insert(0, "/");
  if (space.back() != '/')
    space.push_back('/');
  return space + name;
}

std::string programName(pid_t process, const std::vector<std::string>& arguments) {
  if (!arguments.empty() && !arguments[0].empty())
    return arguments[0].substr(arguments[0].rfind('/') + 1);
  // A process may hide its arguments.
  const std::vector<std::string> name = linesOfFile(procPath(process, "comm"));
  return name.empty() ? "" : name.front();
}

bool hasOpen(pid_t process, const struct stat& node) {
  for (const std::filesystem::path& fd : entriesOf(procPath(process, "fd"))) {
    struct stat open_file {};
    if (::stat(fd.c_str(), &open_file) == 0 && open_file.st_dev == node.st_dev &&
        open_file.st_ino == node.st_ino)
      return true;
  }
  return false;
}

}  // namespace

std::string describeProcess(pid_t process) {
  const std::vector<std::string> arguments = zeroSeparated(procPath(process, "cmdline"));
  const std::string program = programName(process, arguments);
  const std::string node = rosNodeName(process, arguments);
  std::string description;
  if (process == ::getpid())
    description = "this very process";
  else
    description = program.empty() ? "another program" : program;
  description += " (";
  if (!node.empty())
    description += "ROS node " + node + ", ";
  return description + "process " + std::to_string(process) + ")";
}

std::optional<pid_t> lockHolder(int fd) {
  struct stat file {};
  if (::fstat(fd, &file) != 0)
    return std::nullopt;
  const std::string wanted = format("%02x:%02x:%llu", major(file.st_dev), minor(file.st_dev),
                                    static_cast<unsigned long long>(file.st_ino));
  // 1: FLOCK  ADVISORY  WRITE 1234 00:05:678 0 EOF
  for (const std::string& line : linesOfFile("/proc/locks")) {
    std::istringstream words(line);
    std::string number, type, mode, access, place;
    pid_t process = 0;
    if (words >> number >> type >> mode >> access >> process >> place && type == "FLOCK" &&
        place == wanted && process > 0)
      return process;
  }
  return std::nullopt;
}

void lockDevice(int fd, const std::string& remote) {
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0)
    throwTaken(remote, lockHolder(fd));
}

void throwTaken(const std::string& remote, std::optional<pid_t> user) {
  throw DeviceTaken(remote + " is in use by " + (user ? describeProcess(*user) : "another driver") +
                    ": stop that one or choose another device");
}

std::string sharedWith(const std::string& path) {
  struct stat node {};
  if (::stat(path.c_str(), &node) != 0)
    return "";
  std::string others;
  for (const std::filesystem::path& entry : entriesOf("/proc")) {
    const auto process = static_cast<pid_t>(std::atoi(entry.filename().c_str()));
    if (process > 0 && process != ::getpid() && hasOpen(process, node))
      others += (others.empty() ? "" : " and ") + describeProcess(process);
  }
  if (others.empty())
    return "";
  return path + " is open in " + others +
         " too, which may change the settings of the remote: close that program";
}

}  // namespace wiimote_tracker::transport
