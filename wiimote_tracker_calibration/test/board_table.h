#pragma once

#include <array>
#include <cmath>
#include <vector>

namespace wiimote_tracker::intrinsics {

/// The timing table of doc/board.md, written down once more: start of a flash [ms], its LEDs.
struct TableLine {
  int start;
  std::array<int, 4> leds;
};
constexpr std::array<TableLine, 8> kTable = {{
    {0, {0, 1, 2, 3}},
    {60, {4, 5, 6, 7}},
    {120, {8, 9, 10, 11}},
    {180, {12, 13, 14, 15}},
    {240, {0, 4, 8, 12}},
    {480, {1, 5, 9, 13}},
    {720, {2, 6, 10, 14}},
    {960, {3, 7, 11, 15}},
}};
constexpr int kCycleMs = 1980;
constexpr int kFlashMs = 40;

/// The LEDs that are lit at a time since the start of a cycle [s, >= 0].
inline std::vector<int> litAt(double seconds) {
  const double ms = std::fmod(1e3 * seconds, kCycleMs);
  for (const TableLine& line : kTable) {
    if (ms >= line.start && ms < line.start + kFlashMs)
      return {line.leds.begin(), line.leds.end()};
  }
  return {};
}

}  // namespace wiimote_tracker::intrinsics
