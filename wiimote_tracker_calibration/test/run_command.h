#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <string>
#include <utility>

namespace wiimote_tracker {

/// Exit status of a shell's command that is to end by itself, and what it says.
inline std::pair<int, std::string> runCommand(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string output;
  char buffer[256];
  while (fgets(buffer, sizeof buffer, pipe) != nullptr)
    output += buffer;
  return {WEXITSTATUS(pclose(pipe)), output};
}

}  // namespace wiimote_tracker
