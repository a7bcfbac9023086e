#include "process.h"

#include "clock.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace wiimote_tracker::real_kernel {
namespace {

std::string nextLog() {
  static int number = 0;
  return "/tmp/process_" + std::to_string(++number);
}

}  // namespace

Process::Process(const std::vector<std::string>& command) : log_(nextLog()) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const int log = ::open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  pid_ = log < 0 ? -1 : ::fork();
  if (pid_ == 0) {
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
  }
  ::close(log);
  if (pid_ < 0)
    throw std::runtime_error("cannot start " + command.front());
}

std::string Process::output() const {
  std::ostringstream text;
  text << std::ifstream(log_).rdbuf();
  return text.str();
}

bool Process::says(const std::string& text, double timeout) const {
  return waitFor([&] { return output().find(text) != std::string::npos; }, timeout);
}

std::optional<int> Process::wait(double timeout) {
  int status = 0;
  const bool ended =
      pid_ > 0 && waitFor([&] { return ::waitpid(pid_, &status, WNOHANG) == pid_; }, timeout);
  if (!ended)
    return std::nullopt;
  pid_ = -1;
  return WIFEXITED(status) ? std::optional<int>(WEXITSTATUS(status)) : std::nullopt;
}

void Process::end() {
  constexpr double kPatience = 5.0;  // [s]
  if (pid_ <= 0)
    return;
  ::kill(pid_, SIGTERM);
  wait(kPatience);
  if (pid_ > 0)
    ::kill(pid_, SIGKILL);
}

}  // namespace wiimote_tracker::real_kernel
