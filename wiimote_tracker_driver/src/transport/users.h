#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

/// Who uses a device, as far as /proc shows it to this process. Thread-safe.
namespace wiimote_tracker::transport {

/// A process for the user: "driver_node (ROS node /wiimote_1/driver, process 1234)", or "this very
/// process (...)". Names that cannot be read are omitted.
std::string describeProcess(pid_t process);

/// The process that has locked (flock) the file that `fd` is open on.
std::optional<pid_t> lockHolder(int fd);

/// Locks (flock) the file that `fd` is open on as that of `remote`, e.g. "the Wii Remote 00:...",
/// until `fd` is closed. @throws DeviceTaken, which says who has it.
void lockDevice(int fd, const std::string& remote);

/// Throws the error for a remote that is in use, by `user` where known.
[[noreturn]] void throwTaken(const std::string& remote, std::optional<pid_t> user);

/// One sentence when other programs, which ignore our lock, have the device node at `path` open and
/// may change the remote's settings; else empty. Takes milliseconds: not for a thread that reads
/// reports.
std::string sharedWith(const std::string& path);

}  // namespace wiimote_tracker::transport
