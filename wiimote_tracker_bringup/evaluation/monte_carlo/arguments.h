#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_ARGUMENTS_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_ARGUMENTS_H

#include <cstdint>
#include <functional>
#include <string>

namespace wiimote_tracker::monte_carlo {

/// Arguments of every program of the evaluation: --rig FILE --output FILE [--seed N] [--sessions N]
/// [--first N]
struct Arguments {
  std::string rig;         ///< Path of a rig's description.
  std::string output;      ///< Path of the table or folder to write.
  std::uint32_t seed = 1;  ///< Of everything random.
  int sessions = 1;        ///< Independent repetitions [1..100000].
  int first = 0;           ///< Number of the first one, to share them between programs.
};

/// Seed of one session; independent for different seeds and sessions.
std::uint32_t sessionSeed(const Arguments& arguments, int session);

/// A program's main(): parses the arguments and measures; reports an error in one sentence on
/// stderr.
/// @param purpose one sentence for --help. @returns the exit status.
int runProgram(int argc,
               char** argv,
               const std::string& purpose,
               const std::function<void(const Arguments&)>& measure);

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_ARGUMENTS_H
