// The sketch of the board lights what the decoder expects: the table of doc/board.md.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace {

// What an Arduino gives its sketches, with a clock that goes on by itself.
namespace arduino {

using byte = unsigned char;
enum { OUTPUT };

unsigned long clock = 0;  // [us]
std::map<int, bool> outputs;

struct Change {
  unsigned long time;  // [us]
  int pin;
  bool high;
};
std::vector<Change> changes;

void pinMode(int pin, int /*mode*/) {
  outputs[pin] = false;
}

unsigned long micros() {
  return clock += 4;
}

void digitalWrite(int pin, int level) {
  ++clock;
  outputs.at(pin) = level != 0;
  changes.push_back({clock, pin, level != 0});
}

#include "../doc/board/board.ino"

}  // namespace arduino

/// LEDs, by number, with a switched-on row and column at this time.
std::set<int> litAt(unsigned long time) {
  std::map<int, bool> high;
  for (const arduino::Change& change : arduino::changes) {
    if (change.time > time)
      break;
    high[change.pin] = change.high;
  }
  std::set<int> lit;
  for (int led = 0; led < 16; ++led) {
    if (high[arduino::kRows[led / 4]] && high[arduino::kColumns[led % 4]])
      lit.insert(led);
  }
  return lit;
}

TEST(BoardSketch, LightsTheTable) {
  const std::map<int, std::set<int>> table = {
      // by the beginning [ms]
      {0, {0, 1, 2, 3}},    {60, {4, 5, 6, 7}},   {120, {8, 9, 10, 11}}, {180, {12, 13, 14, 15}},
      {240, {0, 4, 8, 12}}, {480, {1, 5, 9, 13}}, {720, {2, 6, 10, 14}}, {960, {3, 7, 11, 15}}};
  arduino::setup();
  const unsigned long start = arduino::step_start;
  for (int step = 0; step < 2 * 33; ++step)
    arduino::loop();
  for (int ms = 1; ms < 2 * 1980; ms += 2) {
    const int in_cycle = ms % 1980;
    const auto flash = table.find(in_cycle - in_cycle % 60);
    const bool is_lit = flash != table.end() && in_cycle % 60 < 40;
    EXPECT_EQ(is_lit ? flash->second : std::set<int>(), litAt(start + 1000ul * ms)) << ms << " ms";
  }
}

}  // namespace
