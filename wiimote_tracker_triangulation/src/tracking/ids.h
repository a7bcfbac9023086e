#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IDS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IDS_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::tracking {

/// Identifies a spot: its image's number and its index in the image.
struct SpotKey {
  std::uint64_t image;
  std::size_t spot;
};

/// Gives each new track an unused id. When a late image makes the tracker repeat its steps, a track
/// that starts from some of the same spots gets its former id.
class Ids {
 public:
  /// @param initial_spots the spots that start the track. @param in_use whether an id is taken.
  template <typename InUse>
  std::uint32_t idFor(const std::vector<SpotKey>& initial_spots, double time, const InUse& in_use) {
    for (const IdRecord& record : records_) {
      for (const SpotKey& key : initial_spots) {
        if (key.image == record.key.image && key.spot == record.key.spot && !in_use(record.id))
          return remember(initial_spots, time, record.id);
      }
    }
    return remember(initial_spots, time, next_++);
  }

  /// Steps before this time [s] will not be repeated.
  void forgetBefore(double time);

 private:
  struct IdRecord {
    SpotKey key;
    double time;  // [s]
    std::uint32_t id;
  };

  std::uint32_t remember(const std::vector<SpotKey>& initial_spots, double time, std::uint32_t id);

  std::uint32_t next_ = 0;
  std::vector<IdRecord> records_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IDS_H
