#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_WAVEFORM_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_WAVEFORM_H

#include <vector>

namespace wiimote_tracker::identity {

/// A time in which an LED is on, in shares of its period: 0 <= from < to <= 1.
struct Lit {
  double from = 0.0;
  double to = 1.0;
};

/// When an LED is on during one period: ascending, with darkness between one and the next. One that
/// ends at 1 goes on with one that begins at 0.
using Waveform = std::vector<Lit>;

/// The share of the time that an LED is on while its phase goes from `from` to `from + length`.
/// @param from phase, any number; @param length at least 0; 0: 0 or 1, at that phase.
double litShare(const Waveform& waveform, double from, double length);

/// Longest time without light [periods]; infinite for one that is never on.
double longestDark(const Waveform& waveform);

/// Shortest time with or without light [periods]; 1 when it is always on.
double shortestRun(const Waveform& waveform);

/// Share of the time in which one of the two is on and the other is not, when the second is ahead
/// by `shift` periods.
double difference(const Waveform& one, const Waveform& other, double shift);

/// The same for the shift that makes it least: what tells two LEDs apart whose phases are unknown.
double differenceInAnyRotation(const Waveform& one, const Waveform& other);

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_WAVEFORM_H
