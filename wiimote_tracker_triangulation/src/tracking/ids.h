#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IDS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IDS_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::tracking {

/// One spot of all: the image's number, and its place in that image.
struct SpotKey {
  std::uint64_t image;
  std::size_t spot;
};

/// Gives tracks their ids, none twice; but when a late image has the past repeated, an LED that
/// begins again with some of the same spots is the one that it was.
class Ids {
 public:
  /// @param founders the spots that the track begins with. @param in_use whether an id is taken.
  template <typename InUse>
  std::uint32_t idFor(const std::vector<SpotKey>& founders, double time, const InUse& in_use) {
    for (const Birth& birth : births_) {
      for (const SpotKey& key : founders) {
        if (key.image == birth.key.image && key.spot == birth.key.spot && !in_use(birth.id))
          return remember(founders, time, birth.id);
      }
    }
    return remember(founders, time, next_++);
  }

  /// Nothing before this time [s] will be repeated.
  void forgetBefore(double time);

 private:
  struct Birth {
    SpotKey key;
    double time;  // [s]
    std::uint32_t id;
  };

  std::uint32_t remember(const std::vector<SpotKey>& founders, double time, std::uint32_t id);

  std::uint32_t next_ = 0;
  std::vector<Birth> births_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IDS_H
