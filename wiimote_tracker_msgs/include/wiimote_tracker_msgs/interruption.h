#pragma once

#include <csignal>

namespace wiimote_tracker {

/// A signal is to end the program, once its destructors have removed what is half written. No
/// Error: nothing on the way is to report it. ArgumentParser::run() ends by the signal.
struct Interrupted {
  int signal = 0;
};

/// SIGINT (Ctrl-C) or SIGTERM, after deferInterruption(); 0: none came.
inline volatile std::sig_atomic_t g_interruption = 0;

/// From now on the first SIGINT or SIGTERM waits for throwIfInterrupted(); a second one ends the
/// process at once.
inline void deferInterruption() {
  const auto note = [](int number) {
    g_interruption = number;
    std::signal(number, SIG_DFL);
  };
  for (const int number : {SIGINT, SIGTERM}) {
    if (std::signal(number, note) == SIG_IGN)  // as in a script's background
      std::signal(number, SIG_IGN);
  }
}

/// @throws Interrupted: a signal came.
inline void throwIfInterrupted() {
  if (g_interruption != 0)
    throw Interrupted{g_interruption};
}

}  // namespace wiimote_tracker
