#pragma once

#include <array>
#include <complex>

namespace wiimote_tracker::exposure_clock {

/// Finds polls in step with the camera: an adapter that asks for reports every 10 ms, as in sniff
/// mode, or in a half, a quarter or an eighth of that. The wait for such a poll changes by 0.035 ms
/// from image to image. So it looks like a slow camera, and the clock cannot estimate it.
class PollWatch {
 public:
  void add(double arrival);  ///< [s]
  /// Of a wait that the clock cannot estimate [s^2]; 0 without such polls.
  double waitVariance() const;

 private:
  static constexpr int kIntervals = 4;
  struct Mean {
    std::complex<double> sum;  // Weighted.
    double weight = 0.0;       // Of all reports: grows to 1.
  };
  // Means of exp(2 pi i arrival / interval): of length 1 in step, near 0 else (Rayleigh's test:
  // Mardia, Jupp, Directional Statistics, 2000, sec. 6.3.1).
  std::array<Mean, kIntervals> in_step_;
  // Mean of cos(2 pi (arrival - the one before) / 10 ms): 1 if the wait hardly changes. Random
  // delays change it, and the clock averages it.
  double steady_ = 0.0;
  double last_arrival_ = 0.0;
};

}  // namespace wiimote_tracker::exposure_clock
