#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_PROGRAM_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_PROGRAM_H

#include "description.h"
#include "table.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {

/// One of the independent repetitions of a measurement.
struct Session {
  int number;
  std::uint32_t seed;  ///< Independent for different numbers and --seed.
};

/// A program's main(), with the arguments --rig FILE --output PATH [--seed N] [--sessions N]
/// [--first N]. `measure` gets the rig, the sessions and the path to write to.
/// @param purpose one sentence for --help. @returns the exit status.
int runProgram(int argc,
               char** argv,
               const std::string& purpose,
               const std::function<void(const simulation::Description&,
                                        const std::vector<Session>&,
                                        const std::string&)>& measure);

/// The same for a program that writes one table: `measure` adds a session's rows.
int runProgram(
    int argc,
    char** argv,
    const std::string& purpose,
    const std::vector<std::string>& columns,
    const std::function<void(const simulation::Description&, const Session&, Table*)>& measure);

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_PROGRAM_H
