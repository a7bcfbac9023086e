// Runs one scenario in the guest.
//
//   real_kernel_client --list     names all scenarios and their guests
//   real_kernel_client SCENARIO   runs it; needs root, /dev/uhid and the module hid-wiimote
//
// Prints one line per check; the exit status is 0 when all have passed.
#include "scenarios.h"

#include <cstdio>
#include <exception>
#include <string>

int main(int argc, char** argv) {
  namespace real_kernel = wiimote_tracker::real_kernel;
  const std::string wanted = argc == 2 ? argv[1] : "";
  for (const real_kernel::Scenario& scenario : real_kernel::scenarios()) {
    if (wanted == "--list")
      std::printf("%s %s\n", scenario.name, scenario.guest);
    if (wanted != scenario.name)
      continue;
    real_kernel::Checks checks;
    try {
      scenario.run(checks);
    } catch (const std::exception& e) {
      checks.check("runs to its end", false, e.what());
    }
    checks.check("every image showed the lights of its frame", checks.images.right(),
                 checks.images.text());
    return checks.passed() ? 0 : 1;
  }
  if (wanted == "--list")
    return 0;
  const bool help = wanted == "--help";
  std::fprintf(help ? stdout : stderr,
               "usage: real_kernel_client SCENARIO|--list\n"
               "Runs one scenario as root of a machine with uhid, as real_kernel_test does.\n");
  return help ? 0 : 2;
}
