#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_HISTORY_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_HISTORY_H

#include "wiimote_tracker_triangulation/tracking/numbered_queue.h"

#include <cstdint>
#include <optional>
#include <utility>

namespace wiimote_tracker::tracking {

/// The latest images in the order of their times, and the state before some of them, so that a late
/// image can be inserted at its time and the steps after it repeated (roll-back). Images
/// have a time [s] and the operator < of their order.
template <typename Image, typename State>
class History {
 public:
  const NumberedQueue<Image>& images() const { return images_; }
  /// To change what is not their order.
  NumberedQueue<Image>& images() { return images_; }

  /// Index of the image in the order of time; nothing when no earlier state is kept.
  std::optional<std::uint64_t> placeOf(const Image& image) const {
    std::uint64_t place = images_.end();
    while (place > images_.begin() && image < images_.at(place - 1))
      --place;
    if (!states_.empty() && place < states_.front().before)
      return std::nullopt;
    return place;
  }

  bool canRepeatFrom(std::uint64_t place) const {
    return !states_.empty() && states_.front().before <= place;
  }

  void insert(std::uint64_t place, const Image& image) {
    images_.push() = image;
    for (std::uint64_t i = images_.end() - 1; i > place; --i)
      std::swap(images_.at(i), images_.at(i - 1));
  }

  /// Call after rollBack() to that place.
  void remove(std::uint64_t place) {
    for (std::uint64_t i = place; i + 1 < images_.end(); ++i)
      images_.at(i) = images_.at(i + 1);
    images_.popBack();
  }

  /// Restores the last kept state before an image. Call before insert().
  /// @returns the index of the image that follows this state.
  std::uint64_t rollBack(std::uint64_t place, State* state) {
    while (states_.back().before > place)
      states_.popBack();
    *state = states_.back().state;
    return states_.back().before;
  }

  /// Keeps the state before the image at `place`, for every second image: a compromise between
  /// repeated steps for late images and copies for all images.
  void keep(std::uint64_t place, const State& state) {
    constexpr std::uint64_t kInterval = 2;
    if (!states_.empty() && place < states_.back().before + kInterval)
      return;
    Kept& kept = states_.push();
    kept.before = place;
    kept.state = state;
  }

  /// Changes all states that rollBack() may restore.
  template <typename Change>
  void changeStates(const Change& change) {
    for (std::uint64_t i = states_.begin(); i < states_.end(); ++i)
      change(&states_.at(i).state);
  }

  /// Drops what is not needed to repeat the steps since a time [s].
  void forgetBefore(double time) {
    while (states_.size() > 1 && images_.at(states_.at(states_.begin() + 1).before).time < time)
      states_.popFront();
    while (!images_.empty() && images_.begin() < states_.front().before)
      images_.popFront();
  }

  void clear() {
    images_.clear();
    states_.clear();
  }

 private:
  struct Kept {
    std::uint64_t before = 0;  // the image that comes next
    State state;
  };

  NumberedQueue<Image> images_;
  NumberedQueue<Kept> states_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_HISTORY_H
