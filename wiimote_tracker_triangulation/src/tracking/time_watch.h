#ifndef WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TIME_WATCH_H
#define WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TIME_WATCH_H

#include <cstddef>
#include <limits>
#include <vector>

namespace wiimote_tracker::tracking {

/// Detects from the times of images that time jumped back for all cameras, as when a bag is played
/// in a loop, or that one camera's clock is wrong: ahead of all others, or set back alone. If the
/// first images came from a camera that is ahead, time jumps back to that of the others.
class TimeWatch {
 public:
  static constexpr double kJump = 1.0;  ///< [s]

  explicit TimeWatch(std::size_t cameras) : cameras_(cameras) {}

  enum class Result {
    kUsable,
    kWrongClock,  ///< Do not use: its clock is far from all others.
    kJumpedBack   ///< Usable, after a reset.
  };

  /// @param time of the exposure [s] @param arrival [s]
  Result check(std::size_t camera, double time, double arrival);

  /// Whether the last image arrived before an earlier checked one.
  bool isDisordered() const { return disordered_; }

 private:
  std::size_t countNear(double time) const;

  struct Newest {
    double time = -std::numeric_limits<double>::infinity();
    double arrival = -std::numeric_limits<double>::infinity();
    bool jumped = false;  // its time jumped back and is still behind the others
  };

  /// After this many images in a row from one camera, the others are considered silent.
  static constexpr int kSilence = 100;

  std::vector<Newest> cameras_;
  double used_until_ = -std::numeric_limits<double>::infinity();
  std::size_t images_since_progress_ = 0;  // since used_until_ grew
  double newest_arrival_ = -std::numeric_limits<double>::infinity();
  bool disordered_ = false;
  std::size_t last_camera_ = 0;
  int in_a_row_ = 0;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TRACKING_TIME_WATCH_H
