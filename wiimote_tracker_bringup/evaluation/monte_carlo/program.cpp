#include "program.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <random>

namespace wiimote_tracker::monte_carlo {

int runProgram(int argc,
               char** argv,
               const std::string& purpose,
               const std::function<void(const simulation::Description&,
                                        const std::vector<Session>&,
                                        const std::string&)>& measure) {
  std::string rig, output;
  std::uint32_t seed = 1;
  int count = 1, first = 0;
  ArgumentParser parser(argv[0],
                        purpose + "\nEverything is simulated; the same seed gives the same bytes.");
  parser.option("--rig FILE", &rig, "a rig's description; needed");
  parser.option("--output PATH", &output, "the table or folder to write; needed");
  parser.option("--seed N", &seed, 0, 2147483647, "seed of everything random");
  parser.option("--sessions N", &count, 1, 100000, "independent repetitions");
  parser.option("--first N", &first, 0, 100000, "number of the first, to share them out");
  return parser.run(argc, argv, [&] {
    if (rig.empty() || output.empty())
      throw BadArguments("--rig and --output are needed");
    std::vector<Session> sessions;
    for (int number = first; number < first + count; ++number) {
      std::seed_seq sequence{seed, static_cast<std::uint32_t>(number)};
      sessions.push_back({number, 0});
      sequence.generate(&sessions.back().seed, &sessions.back().seed + 1);
    }
    measure(simulation::readDescription(rig), sessions, output);
    return 0;
  });
}

int runProgram(
    int argc,
    char** argv,
    const std::string& purpose,
    const std::vector<std::string>& columns,
    const std::function<void(const simulation::Description&, const Session&, Table*)>& measure) {
  return runProgram(argc, argv, purpose,
                    [&](const simulation::Description& description,
                        const std::vector<Session>& sessions, const std::string& output) {
                      Table table(output, columns);
                      for (const Session& session : sessions)
                        measure(description, session, &table);
                      table.close();
                    });
}

}  // namespace wiimote_tracker::monte_carlo
