#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SCHEMES_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SCHEMES_H

#include "wiimote_tracker_triangulation/identity/blink_codes.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::identity {

/// An LED that is on for a share of the period (0..1), in its middle.
struct DutyLed {
  std::string label;
  double share = 0.5;
};

/// The paper's scheme: all LEDs blink together, each for another share of the period. The one that
/// is on for longest is switched on first and off last.
/// @param shortest, longest: between which the period lies [s]; alike when it is known.
/// @throws Error.
BlinkCodes dutyCodes(const std::vector<DutyLed>& leds, double shortest, double longest);

/// An LED and its word: a character per chip, 1 is on and 0 is off.
struct CyclicLed {
  std::string label;
  std::string word;
};

/// Cyclic codes: every LED repeats its word for ever, and begins it when it likes.
/// @param chip duration of one character [s].
/// @param tolerance relative error of the LEDs' clocks, 0..0.05.
/// @throws Error: words of different length, alike after rotation, ...
BlinkCodes cyclicCodes(const std::vector<CyclicLed>& leds, double chip, double tolerance);

/// Number of chips in which two words of equal length differ at least, over all rotations.
std::size_t rotationDistance(const std::string& one, const std::string& other);

struct WordRules {
  std::size_t longest_dark = 1;   ///< No more dark chips in a row [1..].
  std::size_t distance = 2;       ///< Chips in which two words differ in every rotation [1..].
  std::size_t longest_word = 20;  ///< Chips [3..20].
};

/// Words for cyclic codes, `count` of them, at least 1: the shortest ones that obey the rules, with
/// much light rather than little. Empty when none were found: words are taken one by one, so that
/// another choice might still exist.
std::vector<std::string> chooseWords(std::size_t count, const WordRules& rules);

/// The same with the rules that suit most: two chips apart, so that one chip seen wrongly makes no
/// other word; single dark chips where words of 8 chips are enough for that, else two in a row.
/// @throws Error: too many.
std::vector<std::string> chooseWords(std::size_t count);

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SCHEMES_H
