#pragma once

namespace wiimote_tracker::transport {

/// Whether reports wait for their reader, from when its reads ended.
class QueueWatch {
 public:
  /// No report waits at `now` [s].
  explicit QueueWatch(double now) : empty_(now) {}

  /// A read, which waits for a report for `timeout` [s] at most, ended at `now` [s].
  void readEnded(bool received, double timeout, double now) {
    age_ = now - empty_;
    // A read that took longer was held up itself, perhaps behind the report's arrival.
    waited_ = age_ > timeout + kPrompt;
    if (timeout > 0.0 ? !waited_ : !received)
      empty_ = now;
  }

  /// Greatest age of the report that was read last [s].
  double age() const { return age_; }
  /// Whether it may have waited, so that the time of the read does not tell when it arrived.
  bool waited() const { return waited_; }

 private:
  // A report that waited for less is as good as one that did not [s].
  static constexpr double kPrompt = 0.002;

  double empty_;  // when no report waited, last [s]
  double age_ = 0.0;
  bool waited_ = false;
};

}  // namespace wiimote_tracker::transport
