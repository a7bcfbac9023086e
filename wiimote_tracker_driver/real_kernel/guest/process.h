#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::real_kernel {

/// A running program of the guest. The destructor ends it.
class Process {
 public:
  /// @throws std::runtime_error if it cannot be started.
  explicit Process(const std::vector<std::string>& command);
  ~Process() { end(); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Its output and errors so far.
  std::string output() const;

  /// Waits until its output contains this text, at most `timeout` [s].
  bool says(const std::string& text, double timeout) const;

  /// Its exit status; nothing when it runs longer than `timeout` [s], or was killed.
  std::optional<int> wait(double timeout);

  void end();

 private:
  const std::string log_;
  pid_t pid_ = -1;
};

}  // namespace wiimote_tracker::real_kernel
