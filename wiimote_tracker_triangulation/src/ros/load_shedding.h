#pragma once

#include <cstdint>
#include <optional>

namespace wiimote_tracker {

/// Decides which images to drop when they come faster than they can be handled. After a short
/// pause of the program the images that wait are worked off, and none is lost. When images have
/// been late for longer, those that waited too long are dropped, so that points stay recent.
class LoadShedding {
 public:
  static constexpr char kAdvice[] =
      "Images come faster than they can be tracked, and some are dropped: use a faster computer, "
      "fewer cameras, or a build with optimisation";

  /// @param wait from the image's receipt to now [s]
  /// @param now by a clock that is never set [s]
  /// @returns whether to drop the image.
  bool drops(double wait, double now) {
    if (wait <= kLongestWait) {
      late_since_.reset();
      return false;
    }
    if (!late_since_)
      late_since_ = now;
    if (!overloaded(now) && now - *late_since_ < kLongestBacklog)
      return false;
    overloaded_until_ = now + kOverloaded;
    ++dropped_;
    return true;
  }

  /// Whether images were dropped in the last seconds.
  bool overloaded(double now) const { return now < overloaded_until_; }

  std::uint64_t dropped() const { return dropped_; }

 private:
  // An image that waited longer is late [s].
  static constexpr double kLongestWait = 0.05;
  // Images that are late for no longer than this are worked off [s]: the backlog of a pause of a
  // second takes less, since one image takes a fraction of the time between two.
  static constexpr double kLongestBacklog = 0.5;
  // After the last dropped image, late ones are dropped at once for this long [s].
  static constexpr double kOverloaded = 5.0;

  std::optional<double> late_since_;  ///< [s] Nothing while images are in time.
  double overloaded_until_ = 0.0;     ///< [s]
  std::uint64_t dropped_ = 0;
};

}  // namespace wiimote_tracker
