#pragma once

#include <array>
#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// Probabilities of the latest report's frame number: the forward recursion of a hidden Markov
/// model (Rabiner, Proc. IEEE 77, 1989, eq. 20) whose transitions are runs of lost frames and,
/// rarely, a duplicate report. The loss probability is estimated.
class FrameCounter {
 public:
  /// Number of frame numbers kept: a report must not wait for more frames than this.
  static constexpr int kCapacity = 96;

  /// Probability that the next report is `frames` frames after this one; 0: a duplicate.
  double transition(std::int64_t frames) const;
  /// Updates the loss probability: a report came after lost frames or after the frame before, with
  /// these probabilities; else it was a duplicate.
  void learn(double lost, double kept);
  void copyLossesFrom(const FrameCounter& other);

  /// The latest report is certainly this frame.
  void start(std::int64_t frame);
  /// Predicts the next report's frame number, up to at least `newest`. The caller multiplies each
  /// probability by the likelihood of the arrival and calls normalise().
  void predict(std::int64_t newest);
  void normalise();

  int size() const { return size_; }
  std::int64_t frame(int i) const { return first_ + i; }
  double& operator[](int i) { return probability_[static_cast<std::size_t>(i)]; }
  double operator[](int i) const { return probability_[static_cast<std::size_t>(i)]; }
  std::int64_t mostProbable() const;

 private:
  std::array<double, kCapacity> probability_{};
  std::int64_t first_ = 0;
  int size_ = 0;
  double loss_probability_ = 0.04;  // after a frame that was not lost,
  double sample_count_ = 0.0;       // and number of reports used for it
};

}  // namespace wiimote_tracker::exposure_clock
