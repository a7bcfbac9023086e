// Tracker and health watch over thirty days.
#include "benchmark_calibration_sections.h"
#include "month_trial.h"

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <string>

namespace wiimote_tracker {
namespace {

constexpr int kDays = 30;
constexpr int kDaysOfRow = 5;
constexpr double kKnock = M_PI / 180.0;

/// Memory of this process [MB].
double residentMemory() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  file >> pages >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

void writeRow(const std::string& name,
              const Month& month,
              const MonthFigures& found,
              const RowCallback& row) {
  row({name,
       {{"images", found.images},
        {"points", found.points},
        {"rms_mm",
         1e3 * std::sqrt(found.squared / static_cast<double>(found.points - found.wrong))},
        {"wrong", found.wrong},
        {"dark", found.hours_dark},
        {"ids", month.highestId() + 1},
        {"reused", found.reused_ids},
        {"alarms", found.alarms},
        {"MB", residentMemory()}}});
}

void runMonth(int part, const RowCallback& row) {
  Month month(1, part);
  for (int day = 0; day < kDays; day += kDaysOfRow) {
    const MonthFigures found = month.run(24 * kDaysOfRow);
    writeRow("days " + std::to_string(day + 1) + " to " + std::to_string(day + kDaysOfRow), month,
             found, row);
  }
  month.knock(kKnock);
  writeRow("8 hours more, a camera turned by 1 degree", month, month.run(8), row);
}

}  // namespace

BenchmarkSection monthSection() {
  return {"month",
          "thirty days of tracker and health watch; of each hour --runs seconds. Points TRACKED, "
          "their error, wrong ones; hours with points of less than half the images; ids so far, "
          "ids that came again; cameras said to have moved; memory",
          runMonth};
}

}  // namespace wiimote_tracker
