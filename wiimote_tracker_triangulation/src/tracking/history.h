#pragma once

#include "wiimote_tracker_triangulation/tracking/numbered_queue.h"

#include <cstdint>
#include <optional>
#include <utility>

namespace wiimote_tracker::tracking {

/// What happened to an image. kLate: it comes before others, or instead of a mistimed one.
enum class Outcome { kAdded, kLate, kRepeated, kDropped };

/// The latest images in the order of their times, and the state before some of them, so that a late
/// image can be inserted at its time and the steps after it repeated (roll-back).
/// @tparam Image a TimedImage.
template <typename Image, typename State>
class History {
 public:
  /// @param state after the steps of the images so far; not owned. @param length of the history
  /// [s].
  History(State* state, double length) : state_(*state), length_(length) {}
  History(const History&) = delete;  // the copy's state would be the original's

  /// Inserts an image, instead of a mistimed one. Its step follows with catchUp(), as do those that
  /// it changes.
  Outcome add(const Image& image) {
    auto place = placeOf(image);
    if (!place)
      return Outcome::kDropped;
    if (*place < images_.end() && !(image < images_.at(*place)))
      return Outcome::kRepeated;
    const auto mistimed = mistimedBefore(*place, image);
    const bool is_late = mistimed || *place < images_.end();
    if (mistimed) {
      remove(*mistimed);
      --*place;
    }
    insert(*place, image);
    return is_late ? Outcome::kLate : Outcome::kAdded;
  }

  /// Index of an image in the order of time; nothing when it is too old.
  std::optional<std::uint64_t> placeOf(const Image& image) const {
    if (!images_.empty() && image.time < images_.back().time - length_)
      return std::nullopt;
    std::uint64_t place = images_.end();
    while (place > images_.begin() && !(images_.at(place - 1) < image))
      --place;
    if (!states_.empty() && place < states_.front().before)
      return std::nullopt;
    return place;
  }

  /// Carries out the steps of all images that lack them: step(image) changes the state.
  template <typename Step>
  void catchUp(const Step& step) {
    for (; next_ < images_.end(); ++next_) {
      keepState();
      step(images_.at(next_));
    }
    forgetOld();
  }

  /// Undoes the steps from the image of this index on, and perhaps one more.
  void rollBack(std::uint64_t place) {
    if (place >= next_)
      return;
    while (states_.back().before > place)
      states_.popBack();
    state_ = states_.back().state;
    next_ = states_.back().before;
  }

  /// To change what is not their order.
  NumberedQueue<Image>& images() { return images_; }

  /// Changes all states that rollBack() may restore.
  template <typename Change>
  void changeStates(const Change& change) {
    for (std::uint64_t i = states_.begin(); i < states_.end(); ++i)
      change(&states_.at(i).state);
  }

  void clear() {
    images_.clear();
    states_.clear();
    next_ = 0;
  }

 private:
  struct Kept {
    std::uint64_t before = 0;  // the image that comes next
    State state;
  };

  /// Finds an image of the same camera at nearly the same time. A busy computer delivers delayed
  /// images in a burst with nearly equal stamps, of which only the last is right. The others would
  /// make the LED appear to stop and jump.
  std::optional<std::uint64_t> mistimedBefore(std::uint64_t place, const Image& image) const {
    constexpr double kLeastInterval = 1e-4;  // between exposures of one camera [s]
    for (std::uint64_t i = place; i > images_.begin(); --i) {
      if (!states_.empty() && i <= states_.front().before)
        break;  // no state is kept before it
      const Image& before = images_.at(i - 1);
      if (before.time < image.time - kLeastInterval)
        break;
      if (before.camera == image.camera && before.arrival <= image.arrival)
        return i - 1;
    }
    return std::nullopt;
  }

  void insert(std::uint64_t place, const Image& image) {
    rollBack(place);
    images_.push() = image;
    for (std::uint64_t i = images_.end() - 1; i > place; --i)
      std::swap(images_.at(i), images_.at(i - 1));
  }

  void remove(std::uint64_t place) {
    rollBack(place);
    for (std::uint64_t i = place; i + 1 < images_.end(); ++i)
      images_.at(i) = images_.at(i + 1);
    images_.popBack();
  }

  /// For every second image: a compromise between repeated steps for late images and copies for all
  /// images.
  void keepState() {
    constexpr std::uint64_t kInterval = 2;
    if (!states_.empty() && next_ < states_.back().before + kInterval)
      return;
    Kept& kept = states_.push();
    kept.before = next_;
    kept.state = state_;
  }

  /// Drops what no image needs that is not too old.
  void forgetOld() {
    const auto isOld = [&](const Kept& kept) {
      return images_.at(kept.before).time < images_.back().time - length_;
    };
    while (states_.size() > 1 && isOld(states_.at(states_.begin() + 1)))
      states_.popFront();
    while (!images_.empty() && images_.begin() < states_.front().before)
      images_.popFront();
  }

  State& state_;  // before the image of index next_
  double length_;
  std::uint64_t next_ = 0;
  NumberedQueue<Image> images_;
  NumberedQueue<Kept> states_;
};

}  // namespace wiimote_tracker::tracking
