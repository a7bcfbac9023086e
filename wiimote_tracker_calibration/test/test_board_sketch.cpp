// The sketch of the board lights what the decoder expects: the table of doc/board.md.
#include "arduino.h"
#include "board_table.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

namespace arduino {
#include "../doc/board/board.ino"
}  // namespace arduino

namespace {

/// LEDs, by number, with a switched-on row and column at this time.
std::set<int> litAt(unsigned long time) {
  std::map<int, bool> high;
  for (const arduino::Change& change : arduino::changes) {
    if (change.time > time)
      break;
    high[change.pin] = change.level == arduino::HIGH;
  }
  std::set<int> lit;
  for (int led = 0; led < 16; ++led) {
    if (high[arduino::kRows[led / 4]] && high[arduino::kColumns[led % 4]])
      lit.insert(led);
  }
  return lit;
}

TEST(BoardSketch, LightsTheTable) {
  arduino::setup();
  const unsigned long start = arduino::step_start;
  for (int step = 0; step < 2 * 33; ++step)
    arduino::loop();
  for (int ms = 1; ms < 2 * wiimote_tracker::intrinsics::kCycleMs; ms += 2) {
    const std::vector<int> lit = wiimote_tracker::intrinsics::litAt(1e-3 * ms);
    EXPECT_EQ(std::set<int>(lit.begin(), lit.end()), litAt(start + 1000ul * ms)) << ms << " ms";
  }
}

}  // namespace
