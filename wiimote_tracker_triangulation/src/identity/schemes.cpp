#include "wiimote_tracker_triangulation/identity/schemes.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <algorithm>
#include <bitset>
#include <cstdint>

namespace wiimote_tracker::identity {
namespace {

constexpr std::size_t kLongestWord = 20;

Waveform waveformOf(const CyclicLed& led) {
  Waveform waveform;
  const double length = led.word.size();
  for (std::size_t i = 0; i < led.word.size(); ++i) {
    if (led.word[i] != '0' && led.word[i] != '1')
      throw Error("the word of " + led.label + " is '" + led.word + "'; write it with 0 and 1");
    if (led.word[i] == '0')
      continue;
    const double to = (i + 1) / length;
    if (i > 0 && led.word[i - 1] == '1')
      waveform.back().to = to;
    else
      waveform.push_back({i / length, to});
  }
  return waveform;
}

/// A word of up to 20 chips as bits.
using Bits = std::uint32_t;

Bits rotated(Bits word, std::size_t length) {
  return (word >> 1) | ((word & 1u) << (length - 1));
}

std::size_t ones(Bits word) {
  return std::bitset<kLongestWord>(word).count();
}

std::size_t distanceOf(Bits one, Bits other, std::size_t length) {
  std::size_t least = length;
  for (std::size_t i = 0; i < length; ++i, other = rotated(other, length))
    least = std::min(least, ones(one ^ other));
  return least;
}

/// Picks one representative of the rotations of a word.
bool isSmallestRotation(Bits word, std::size_t length) {
  Bits other = word;
  for (std::size_t i = 1; i < length; ++i) {
    other = rotated(other, length);
    if (other < word)
      return false;
  }
  return true;
}

/// Whether `dark` chips in a row are off. A word that is its own smallest rotation starts with its
/// longest dark run.
bool isDarkFor(Bits word, std::size_t length, std::size_t dark) {
  return dark <= length && (word >> (length - dark)) == 0;
}

/// All usable words of a length, those with the most light first.
std::vector<Bits> usableWords(std::size_t length, std::size_t longest_dark) {
  std::vector<Bits> words;
  const Bits all = (Bits{1} << length) - 1;
  for (Bits word = 1; word < all; ++word) {
    if (!isDarkFor(word, length, longest_dark + 1) && isSmallestRotation(word, length))
      words.push_back(word);
  }
  std::stable_sort(words.begin(), words.end(), [](Bits a, Bits b) { return ones(a) > ones(b); });
  return words;
}

/// Greedy choice from `first` on of candidates at the required distance from those taken.
std::vector<Bits> takeInTurn(const std::vector<Bits>& candidates,
                             std::size_t first,
                             std::size_t count,
                             std::size_t length,
                             std::size_t distance) {
  std::vector<Bits> taken;
  for (std::size_t i = first; i < candidates.size() && taken.size() < count; ++i) {
    if (std::all_of(taken.begin(), taken.end(), [&](Bits other) {
          return distanceOf(candidates[i], other, length) >= distance;
        }))
      taken.push_back(candidates[i]);
  }
  return taken;
}

std::string text(Bits word, std::size_t length) {
  return std::bitset<kLongestWord>(word).to_string().substr(kLongestWord - length);
}

}  // namespace

BlinkCodes dutyCodes(const std::vector<DutyLed>& leds, double shortest, double longest) {
  BlinkCodes codes;
  codes.synchronous = true;
  codes.shortest_period = shortest;
  codes.longest_period = longest;
  for (const DutyLed& led : leds) {
    if (!(led.share > 0.0 && led.share < 1.0))
      throw Error("the share of " + led.label + " must be between 0 and 1; correct it");
    codes.codes.push_back({led.label, {{0.5 - 0.5 * led.share, 0.5 + 0.5 * led.share}}});
  }
  codes.check();
  return codes;
}

BlinkCodes cyclicCodes(const std::vector<CyclicLed>& leds, double chip, double tolerance) {
  if (!(tolerance >= 0.0 && tolerance <= 0.05))
    throw Error("the clocks' tolerance must be within 0 and 0.05; correct it");
  if (!(chip >= 0.001 && chip <= 1.0))
    throw Error("a chip must last 0.001 to 1 s; correct it");
  BlinkCodes codes;
  for (const CyclicLed& led : leds) {
    if (led.word.size() != leds.front().word.size() || led.word.size() < 2 ||
        led.word.size() > kLongestWord)
      throw Error("the word of " + led.label +
                  " has another length than that of the first LED, or not 2 to 20 chips; "
                  "use words of equal length");
    codes.codes.push_back({led.label, waveformOf(led)});
  }
  const double period = leds.empty() ? chip : chip * leds[0].word.size();
  codes.shortest_period = period * (1.0 - tolerance);
  codes.longest_period = period * (1.0 + tolerance);
  codes.check();
  return codes;
}

std::vector<std::string> chooseWords(std::size_t count, const WordRules& rules) {
  for (std::size_t length = 3; length <= std::min(rules.longest_word, kLongestWord); ++length) {
    const std::vector<Bits> candidates = usableWords(length, rules.longest_dark);
    for (std::size_t first = 0; first + count <= candidates.size(); ++first) {
      const std::vector<Bits> chosen = takeInTurn(candidates, first, count, length, rules.distance);
      if (chosen.size() < count)
        continue;
      std::vector<std::string> words;
      for (const Bits word : chosen)
        words.push_back(text(word, length));
      return words;
    }
  }
  return {};
}

std::vector<std::string> chooseWords(std::size_t count) {
  WordRules single_dark;
  single_dark.longest_word = 8;
  WordRules two_dark;
  two_dark.longest_dark = 2;
  std::vector<std::string> words = chooseWords(count, single_dark);
  if (words.empty())
    words = chooseWords(count, two_dark);
  if (words.empty())
    throw Error("no words were found for " + std::to_string(count) +
                " LEDs; ask for at least 1 and at most a few hundred");
  return words;
}

}  // namespace wiimote_tracker::identity
