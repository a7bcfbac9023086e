#ifndef WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_FRAME_COUNTER_H
#define WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_FRAME_COUNTER_H

#include <array>
#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// Probabilities of the frame number of the latest report: a hidden Markov model whose hidden state
/// is the number and whose transitions are runs of lost frames.
class FrameCounter {
 public:
  /// Numbers told apart; older ones are beyond a stall's reach.
  static constexpr int kCapacity = 96;

  void start(std::int64_t frame);
  /// Probabilities of the next report's number before its arrival is weighed, for numbers up to `newest`.
  void predict(std::int64_t newest);
  /// Multiplies with likelihoods (see at()) and normalises.
  void normalise();

  std::int64_t first() const { return first_; }
  int size() const { return size_; }
  double& operator[](int i) { return probability_[i]; }
  double operator[](int i) const { return probability_[i]; }

 private:
  std::array<double, kCapacity> probability_{};
  std::int64_t first_ = 0;
  int size_ = 0;
};

}  // namespace wiimote_tracker::exposure_clock

#endif
