#pragma once

namespace wiimote_tracker::health {

/// An alarm with hysteresis: it begins when two successive judgements reach the limit, and ends
/// when two are well below it.
class Alarm {
 public:
  /// One judgement. @param ratio of what was found to its limit [1, >= 0].
  void judge(double ratio) {
    const bool contradicts = on_ ? ratio < kEnd : ratio >= 1.0;
    count_ = contradicts ? count_ + 1 : 0;
    if (count_ >= kInSuccession) {
      on_ = !on_;
      count_ = 0;
    }
  }

  bool on() const { return on_; }

 private:
  static constexpr double kEnd = 0.7;
  static constexpr int kInSuccession = 2;

  bool on_ = false;
  int count_ = 0;  // Judgements in succession that contradict on_.
};

}  // namespace wiimote_tracker::health
