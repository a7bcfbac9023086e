#ifndef WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TIME_WATCH_H
#define WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TIME_WATCH_H

#include <cstddef>
#include <limits>
#include <vector>

namespace wiimote_tracker::tracking {

/// Tells from the times of images when all time jumped back, as at the end of a bag that is played
/// in a loop, and when one camera's clock is off: ahead of all others', or put back while the
/// others go on. When a camera that is ahead came first, time jumps back to where the others agree.
class TimeWatch {
 public:
  static constexpr double kJump = 1.0;  ///< [s]

  explicit TimeWatch(std::size_t cameras) : cameras_(cameras) {}

  enum class Verdict {
    kUsable,
    kOff,        ///< Not to be used: the camera's clock is far from all others'.
    kJumpedBack  ///< Usable, when all before it is forgotten.
  };

  /// @param time of the exposure [s] @param arrival [s]
  Verdict look(std::size_t camera, double time, double arrival);

  /// Whether an image that arrived later was looked at before the last one.
  bool isDisordered() const { return disordered_; }

 private:
  std::size_t countNear(double time) const;

  struct Newest {
    double time = -std::numeric_limits<double>::infinity();
    double arrival = -std::numeric_limits<double>::infinity();
    bool jumped = false;  // back, and is still behind the others
  };

  /// As many images in a row of one camera, and the others count as silent.
  static constexpr int kSilence = 100;

  std::vector<Newest> cameras_;
  double used_until_ = -std::numeric_limits<double>::infinity();
  std::size_t stood_still_ = 0;  // images since used_until_ grew
  double newest_arrival_ = -std::numeric_limits<double>::infinity();
  bool disordered_ = false;
  std::size_t last_camera_ = 0;
  int in_a_row_ = 0;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TIME_WATCH_H
