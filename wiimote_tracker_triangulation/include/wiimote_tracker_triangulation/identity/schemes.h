#pragma once

#include "wiimote_tracker_triangulation/identity/blink_codes.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::identity {

/// An LED that is on for a share of the period (0..1), centred in it.
struct DutyLed {
  std::string label;
  double share = 0.5;
};

/// The paper's scheme: all LEDs blink synchronously, each with another duty cycle. The LED with the
/// longest one is switched on first and off last.
/// @param shortest, longest bounds of the period [s]; equal when it is known.
/// @throws Error.
BlinkCodes dutyCodes(const std::vector<DutyLed>& leds, double shortest, double longest);

/// An LED and its word: one character per chip, 1 for on and 0 for off.
struct CyclicLed {
  std::string label;
  std::string word;
};

/// Cyclic codes: every LED repeats its word, with a phase of its own.
/// @param chip duration of one character [s].
/// @param tolerance relative error of the LEDs' clocks, 0..0.05.
/// @throws Error, for example for words of different length or equal up to rotation.
BlinkCodes cyclicCodes(const std::vector<CyclicLed>& leds, double chip, double tolerance);

struct WordRules {
  std::size_t longest_dark = 1;   ///< Most dark chips in a row [1..].
  std::size_t distance = 2;       ///< Least Hamming distance of two words, however rotated [1..].
  std::size_t longest_word = 20;  ///< Chips [3..20].
};

/// Chooses `count` words, at least 1, for cyclic codes: the shortest that obey the rules,
/// preferring words with more light. Empty when none were found: the search is greedy and may miss
/// a solution.
std::vector<std::string> chooseWords(std::size_t count, const WordRules& rules);

/// With recommended rules: distance 2, so that one wrong chip does not yield another word; single
/// dark chips if words of up to 8 chips suffice, else up to two in a row.
/// @throws Error: too many LEDs.
std::vector<std::string> chooseWords(std::size_t count);

}  // namespace wiimote_tracker::identity
