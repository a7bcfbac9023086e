#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <functional>
#include <stdexcept>

namespace wiimote_tracker {

/// A child process, ended with this object or with its parent.
class Process {
 public:
  /// Forks; call it while this process has one thread. The child runs the function, which should
  /// not return. @throws std::runtime_error.
  explicit Process(const std::function<void()>& run) : id_(::fork()) {
    if (id_ < 0)
      throw std::runtime_error("no process can be started: end others, and try again");
    if (id_ != 0)
      return;
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    run();
    ::_exit(127);
  }
  ~Process() {
    ::kill(id_, SIGTERM);
    ::waitpid(id_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  bool hasEnded() const {
    siginfo_t info{};  // its id stays taken until the destructor has waited for it
    return ::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == id_;
  }

  /// Of all its threads [s]. @throws std::runtime_error when it has ended.
  double processorTime() const {
    clockid_t clock{};
    timespec time{};
    if (::clock_getcpuclockid(id_, &clock) != 0 || ::clock_gettime(clock, &time) != 0)
      throw std::runtime_error("a node under test has ended: see its messages above");
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

 private:
  const pid_t id_;
};

}  // namespace wiimote_tracker
