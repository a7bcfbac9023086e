#include "listing.h"

#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <set>

namespace wiimote_tracker::blink_codes_tool {
namespace {

using identity::BlinkCode;
using identity::BlinkCodes;
using identity::Lit;

double light(const BlinkCode& code) {
  return identity::litShare(code.waveform, 0.0, 1.0);
}

long microseconds(double share, double period) {
  return std::lround(1e6 * share * period);
}

}  // namespace

std::string table(const BlinkCodes& codes, double period) {
  std::string text = format("period %.3f ms, %s\n", 1e3 * period,
                            codes.synchronous ? "synchronous" : "asynchronous");
  text += format("%-16s %7s %10s  %s\n", "label", "light", "dark for", "on from - to [ms]");
  for (const BlinkCode& code : codes.codes) {
    text += format("%-16s %5.1f %% %7.2f ms ", code.label.c_str(), 100.0 * light(code),
                   1e3 * period * identity::longestDark(code.waveform));
    for (const Lit& lit : code.waveform)
      text += format(" %.3f-%.3f", 1e3 * period * lit.from, 1e3 * period * lit.to);
    text += "\n";
  }
  return text;
}

std::string sketch(const BlinkCodes& codes, double period) {
  std::set<long> times = {0};
  for (const BlinkCode& code : codes.codes) {
    for (const Lit& lit : code.waveform) {
      times.insert(microseconds(lit.from, period));
      times.insert(microseconds(lit.to, period));
    }
  }
  times.insert(microseconds(1.0, period));
  std::string text =
      "// Blinks LEDs so that wiimote_tracker can identify them. A pin drives an LED through a\n"
      "// transistor: HIGH is on.";
  text += codes.synchronous ? " Drive all of them with one board.\n"
                            : " On a board with fewer LEDs remove the other pins.\n";
  text += "struct Led {\n  int pin;\n  int bit;\n};\nconst Led kLeds[] = {\n";
  for (std::size_t i = 0; i < codes.codes.size(); ++i)
    text += format("    {%zu, %zu},  // %s\n", i + 2, i, codes.codes[i].label.c_str());
  text +=
      "};\n\n"
      "// Duration of each step [us] and the state of the LEDs, one character per bit.\n"
      "struct Step {\n  unsigned long duration;\n  const char* lit;\n};\nconst Step kSteps[] = {\n";
  for (auto time = times.begin(); std::next(time) != times.end(); ++time) {
    const double middle = 0.5e-6 * static_cast<double>(*time + *std::next(time)) / period;
    std::string lit;
    for (const BlinkCode& code : codes.codes)
      lit += identity::litShare(code.waveform, middle, 0.0) > 0.5 ? '1' : '0';
    text += format("    {%ldUL, \"", *std::next(time) - *time) + lit + "\"},\n";
  }
  text +=
      "};\n\n"
      "unsigned long step_ends;\n\n"
      "void setup() {\n"
      "  for (const Led& led : kLeds)\n"
      "    pinMode(led.pin, OUTPUT);\n"
      "  step_ends = micros();\n"
      "}\n\n"
      "void loop() {\n"
      "  for (const Step& step : kSteps) {\n"
      "    for (const Led& led : kLeds)\n"
      "      digitalWrite(led.pin, step.lit[led.bit] == '1' ? HIGH : LOW);\n"
      "    step_ends += step.duration;  // from the last step: errors do not add up\n"
      "    while (static_cast<long>(micros() - step_ends) < 0) {\n"
      "    }\n"
      "  }\n"
      "}\n";
  return text;
}

std::string remarks(const BlinkCodes& codes) {
  constexpr double kImageInterval = 0.01;  // of a Wii Remote [s]
  std::string text = format("%zu LED%s, period %.3f", codes.codes.size(),
                            codes.codes.size() == 1 ? "" : "s", 1e3 * codes.shortest_period);
  if (codes.longest_period > codes.shortest_period)
    text += format(" to %.3f", 1e3 * codes.longest_period);
  text += " ms\n";
  double closest = 2.0;
  std::string pair;
  double shortest = 1.0;
  for (std::size_t i = 0; i < codes.codes.size(); ++i) {
    const BlinkCode& one = codes.codes[i];
    shortest = std::min(shortest, identity::shortestRun(one.waveform));
    for (std::size_t j = 0; j < i; ++j) {
      const BlinkCode& other = codes.codes[j];
      const double apart = codes.synchronous
                               ? identity::difference(one.waveform, other.waveform, 0.0)
                               : identity::differenceInAnyRotation(one.waveform, other.waveform);
      if (apart < closest) {
        closest = apart;
        pair = other.label + " and " + one.label;
      }
    }
  }
  if (!pair.empty())
    text +=
        "closest: " + pair + format(", which differ for %.1f %% of the time\n", 100.0 * closest);
  text += format("an LED is dark for up to %.1f ms: tracks must be predicted for longer\n",
                 1e3 * codes.longestDark());
  const double run = 1e3 * shortest * codes.shortest_period;
  if (run < 1e3 * kImageInterval)
    text += format(
        "the shortest pulse or gap is %.1f ms: cameras at 100 images per second "
        "miss some; use a longer period\n",
        run);
  else if (!codes.synchronous && run < 2e3 * kImageInterval)
    text += format(
        "the shortest pulse or gap is %.1f ms: one camera at 100 images per second "
        "shows some in one image only; use a longer chip unless several cameras see "
        "each LED\n",
        run);
  return text;
}

std::string cyclicFile(const std::vector<std::string>& labels, double chip, double tolerance) {
  const std::vector<std::string> words = identity::chooseWords(labels.size());
  std::vector<identity::CyclicLed> leds;
  for (std::size_t i = 0; i < labels.size(); ++i)
    leds.push_back({labels[i], words[i]});
  identity::cyclicCodes(leds, chip, tolerance);  // refuses codes that the reader would refuse
  std::string text = "format: wiimote_tracker_blink_codes\nversion: 1\nscheme: cyclic\n";
  text += format("chip: %.9g  # duration of one character of a word [s]\n", chip);
  text += format("tolerance: %.9g  # relative error of the LED drivers' clocks\n", tolerance);
  text += "leds:\n";
  for (const identity::CyclicLed& led : leds)
    text += "  - {label: " + led.label + ", word: \"" + led.word + "\"}\n";
  return text;
}

}  // namespace wiimote_tracker::blink_codes_tool
