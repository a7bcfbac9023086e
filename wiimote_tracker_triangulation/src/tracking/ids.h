#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::tracking {

/// Identifies a spot: its image's number and its index in the image.
struct SpotKey {
  std::uint64_t image;
  std::size_t spot;

  bool operator==(const SpotKey& other) const { return image == other.image && spot == other.spot; }
};

/// Gives each new track an unused id. When a late image makes the tracker repeat its steps, a track
/// that starts from some of the same spots gets its former id.
class Ids {
 public:
  /// @param initial_spots the spots that start the track. @param in_use whether an id is taken.
  template <typename InUse>
  std::uint32_t idFor(const std::vector<SpotKey>& initial_spots, double time, const InUse& in_use) {
    const auto former = std::find_if(records_.begin(), records_.end(), [&](const IdRecord& record) {
      return std::count(initial_spots.begin(), initial_spots.end(), record.key) > 0 &&
             !in_use(record.id);
    });
    const std::uint32_t id = former == records_.end() ? next_++ : former->id;
    for (const SpotKey& key : initial_spots)
      records_.push_back({key, time, id});
    return id;
  }

  /// Steps before this time [s] will not be repeated.
  void forgetBefore(double time) {
    records_.erase(std::remove_if(records_.begin(), records_.end(),
                                  [&](const IdRecord& record) { return record.time < time; }),
                   records_.end());
  }

 private:
  struct IdRecord {
    SpotKey key;
    double time;  // [s]
    std::uint32_t id;
  };

  std::uint32_t next_ = 0;
  std::vector<IdRecord> records_;
};

}  // namespace wiimote_tracker::tracking
