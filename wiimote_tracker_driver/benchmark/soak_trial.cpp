#include "trials.h"

#include "allocation_counter.h"
#include "fake_remote.h"
#include "soak_stamps.h"

#include "wiimote/wiimote.h"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>

namespace wiimote_tracker {
namespace {

// Offset of disturbances from what the driver does every minute [hours].
constexpr double kPastTheHour = 17.3 / 3600.0;
constexpr std::uint64_t kLifeOfBatteries = 40;  // [hours]
constexpr double kChange = 0.25;                // of batteries [hours]
constexpr std::uint8_t kFull = 0xc0;            // raw level
constexpr double kSettlingOfStamps = 30.0;      // of the stamps in an epoch [s]
constexpr double kLeapAfter = 8.0;              // [days]
// After this time everything has happened once and all buffers have their size.
constexpr std::uint64_t kWarmHours = 25;

/// Memory of this process [MB].
double residentMemory() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  file >> pages >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// The disturbance of each hour. @param length of an hour [s]. @returns until when the remote is
/// away [s].
double disturb(wiimote::FakeRemote& remote, std::uint64_t hour, double length) {
  const std::uint64_t age = hour % kLifeOfBatteries;
  remote.battery = static_cast<std::uint8_t>(kFull - kFull * age / kLifeOfBatteries);
  if (age != 0 && hour % 6 == 0)
    remote.powerCycle();
  else if (age != 0 && hour % 6 == 3)
    remote.mode = 0x30;  // no images
  else
    remote.present = false;
  return remote.now + (age == 0 ? kChange * length : 0.0);
}

}  // namespace

Results runSoak(std::uint64_t reports, double length) {
  wiimote::FakeRemote remote;
  remote.now = 0.0;
  remote.period = 0.010035;  // about that of real ones
  remote.remembers = false;
  wiimote::Wiimote wiimote(
      wiimote::Options(), [&](bool) { return remote.open(); }, [&] { return remote.now; });
  SoakStamps stamps(DriftingClock(24.0 * length, 24.0 * length * kLeapAfter),
                    std::min(kSettlingOfStamps, length / 2.0));
  const std::clock_t begin = std::clock();
  std::uint64_t images = 0;
  std::uint64_t hour = 0;
  double away_until = 0.0;  // [s]
  std::uint8_t lowest = kFull;
  double resident = 0.0;
  Allocations warm;
  while (remote.sent < reports) {
    remote.now += wiimote.idleTime();
    remote.present |= remote.now > away_until;
    if (wiimote.step(0.1)) {
      ++images;
      stamps.add(remote.now, wiimote.link().clock_epoch);
    }
    if (remote.now < (static_cast<double>(hour + 1) + kPastTheHour) * length)
      continue;
    ++hour;
    if (hour == kWarmHours) {
      resident = residentMemory();
      warm = allocations();
    }
    if (wiimote.link().status)
      lowest = std::min(lowest, wiimote.link().status->battery);
    away_until = disturb(remote, hour, length);
  }
  const Allocations end = allocations();
  const double grown = residentMemory() - resident;
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  Results results{{"reports", count(remote.sent), "1"},
                  {"images", count(images), "1"},
                  {"simulated_time", remote.now, "s"},
                  {"disturbances", count(hour), "1"},
                  {"restorations", count(wiimote.link().restorations), "1"},
                  {"clock_epochs", count(wiimote.link().clock_epoch), "1"},
                  {"lowest_battery", count(lowest), "1"},
                  {"processor_time", seconds, "s"},
                  {"processor_time_per_report", 1e9 * seconds / count(remote.sent), "ns"},
                  {"resident_memory_after_first_day", resident, "MB"},
                  {"resident_memory_growth_since_then", grown, "MB"},
                  {"allocations_since_then", count(end.made - warm.made), "1"},
                  {"allocations_not_freed_since_then", count(end.alive) - count(warm.alive), "1"}};
  const Results of_stamps = stamps.results();
  results.insert(results.end(), of_stamps.begin(), of_stamps.end());
  return results;
}

}  // namespace wiimote_tracker
