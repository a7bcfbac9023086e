#include "ids.h"

#include <algorithm>

namespace wiimote_tracker::tracking {

void Ids::forgetBefore(double time) {
  records_.erase(std::remove_if(records_.begin(), records_.end(),
                                [&](const IdRecord& record) { return record.time < time; }),
                 records_.end());
}

std::uint32_t Ids::remember(const std::vector<SpotKey>& initial_spots,
                            double time,
                            std::uint32_t id) {
  // id is passed by value: it may refer to an element of records_.
  for (const SpotKey& key : initial_spots)
    records_.push_back({key, time, id});
  return id;
}

}  // namespace wiimote_tracker::tracking
