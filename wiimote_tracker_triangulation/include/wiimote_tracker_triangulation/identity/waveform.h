#pragma once

#include <vector>

namespace wiimote_tracker::identity {

/// Interval in which an LED is on, in units of its period: 0 <= from < to <= 1.
struct Lit {
  double from = 0.0;
  double to = 1.0;
};

/// Intervals of light in one period, ascending, separated by darkness. An interval that ends at 1
/// continues in one that starts at 0.
using Waveform = std::vector<Lit>;

/// Share of the time that an LED is on while its phase goes from `from` to `from + length`.
/// @param from any number. @param length >= 0; for 0 the result is 0 or 1, at that phase.
double litShare(const Waveform& waveform, double from, double length);

/// Longest dark interval [periods]; infinity for an LED that is never on.
double longestDark(const Waveform& waveform);

/// Shortest interval of light or darkness [periods]; 1 for an LED that is always on.
double shortestRun(const Waveform& waveform);

/// Share of the time in which exactly one of the two is on, when the second is ahead by `shift`
/// periods.
double difference(const Waveform& one, const Waveform& other, double shift);

/// The least difference() over all shifts, which separates two LEDs of unknown phases.
double differenceInAnyRotation(const Waveform& one, const Waveform& other);

}  // namespace wiimote_tracker::identity
