#include "soak_trial.h"

#include "allocation_counter.h"
#include "steady_remote.h"

#include "wiimote/wiimote.h"

#include <unistd.h>

#include <chrono>
#include <fstream>

namespace wiimote_tracker {
namespace {

constexpr double kHour = 3600.0;  // [s]
// Offset of disturbances from what the driver does every minute [s].
constexpr double kPastTheHour = 17.3;
// After this time everything has happened once and all buffers have their size.
constexpr std::uint64_t kWarmHours = 25;

/// Memory of this process [MB].
double residentMemory() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  file >> pages >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// The disturbance of each hour.
void disturb(wiimote::SteadyRemote& remote, std::uint64_t hour) {
  if (hour % 24 == 0)
    remote.disconnect();
  else if (hour % 6 == 0)
    remote.powerCycle();
  else
    remote.loseMode();
}

}  // namespace

Results runSoak(std::uint64_t reports) {
  wiimote::SteadyRemote remote;
  wiimote::Wiimote wiimote(
      wiimote::Options(), [&] { return remote.open(); }, [&] { return remote.now; });
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t images = 0;
  std::uint64_t hour = 0;
  double resident = 0.0;
  Allocations warm;
  while (remote.sent < reports) {
    remote.now += wiimote.idleTime();
    images += wiimote.step(0.1).has_value();
    if (remote.now < static_cast<double>(hour + 1) * kHour + kPastTheHour)
      continue;
    ++hour;
    if (hour == kWarmHours) {
      resident = residentMemory();
      warm = allocations();
    }
    disturb(remote, hour);
  }
  const Allocations end = allocations();
  const double grown = residentMemory() - resident;
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  return {{"reports", count(remote.sent), "1"},
          {"images", count(images), "1"},
          {"simulated_time", remote.now, "s"},
          {"disturbances", count(hour), "1"},
          {"restorations", count(wiimote.link().restorations), "1"},
          {"clock_epochs", count(wiimote.link().clock_epoch), "1"},
          {"time", seconds, "s"},
          {"time_per_report", 1e9 * seconds / count(remote.sent), "ns"},
          {"resident_memory_after_first_day", resident, "MB"},
          {"resident_memory_growth_since_then", grown, "MB"},
          {"allocations_since_then", count(end.made - warm.made), "1"},
          {"allocations_not_freed_since_then", count(end.alive) - count(warm.alive), "1"}};
}

}  // namespace wiimote_tracker
