#ifndef WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_FRAME_COUNTER_H
#define WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_FRAME_COUNTER_H

#include <array>
#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// Probabilities of the frame number of the latest report: the forward recursion of a hidden Markov
/// model (Rabiner, Proc. IEEE 77, 1989, eq. 20) whose transitions are runs of lost frames and,
/// rarely, a second report of the same frame. How often frames are lost is learnt.
class FrameCounter {
 public:
  /// How many numbers are told apart: reports that waited longer than this many frames are not.
  static constexpr int kCapacity = 96;

  /// Probability that the next report is of the frame `frames` after this report's; 0: of the same.
  double transition(std::int64_t frames) const;
  /// A report turned out to be of the frame `frames` after that of the report before.
  void learn(std::int64_t frames);

  /// The latest report is surely this frame.
  void start(std::int64_t frame);
  /// Probabilities of the next report's number, of all up to at least `newest`, before its arrival
  /// is weighed. The caller then multiplies each by its likelihood and calls normalise().
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
  double drops_ = 0.04;      // probability that a frame is lost after one that was not,
  double experience_ = 0.0;  // and number of reports that taught it
};

}  // namespace wiimote_tracker::exposure_clock

#endif
