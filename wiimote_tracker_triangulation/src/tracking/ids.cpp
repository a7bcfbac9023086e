#include "ids.h"

#include <algorithm>

namespace wiimote_tracker::tracking {

void Ids::forgetBefore(double time) {
  births_.erase(std::remove_if(births_.begin(), births_.end(),
                               [&](const Birth& birth) { return birth.time < time; }),
                births_.end());
}

std::uint32_t Ids::remember(const std::vector<SpotKey>& founders, double time, std::uint32_t id) {
  // By value: id may be that of one of them.
  for (const SpotKey& key : founders)
    births_.push_back({key, time, id});
  return id;
}

}  // namespace wiimote_tracker::tracking
