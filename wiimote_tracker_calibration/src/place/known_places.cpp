#include "place/known_places.h"

namespace wiimote_tracker::place {

std::size_t KnownPlaces::useRig(const std::string& rig_id) {
  if (rig_id == rig_id_)
    return 0;
  const std::size_t dropped = places_.size();
  places_.clear();
  rig_id_ = rig_id;
  return dropped;
}

bool KnownPlaces::undo() {
  if (places_.empty())
    return false;
  places_.pop_back();
  return true;
}

}  // namespace wiimote_tracker::place
