#pragma once

#include <set>
#include <stdexcept>
#include <vector>

/// What an Arduino gives its sketches, with a clock that goes on by itself. A test includes its
/// sketch in this namespace.
namespace arduino {

using byte = unsigned char;
// NOLINTNEXTLINE(readability-identifier-naming): the sketches call them so
constexpr int OUTPUT = 1, HIGH = 1, LOW = 0;

struct Change {
  unsigned long time;  ///< [us]
  int pin;
  int level;
};

inline unsigned long clock = 0;  // [us]
inline std::set<int> outputs;
inline std::vector<Change> changes;

inline void pinMode(int pin, int mode) {
  if (mode == OUTPUT)
    outputs.insert(pin);
}

inline unsigned long micros() {
  return clock += 4;
}

inline void digitalWrite(int pin, int level) {
  if (outputs.count(pin) == 0)
    throw std::logic_error("the sketch writes to a pin that is no output");
  changes.push_back({clock, pin, level});
}

}  // namespace arduino
