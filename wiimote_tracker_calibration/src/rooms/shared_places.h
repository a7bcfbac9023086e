#pragma once

#include "rooms/passages.h"
#include "rooms/rig_motion.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <array>
#include <optional>

namespace wiimote_tracker::rooms {

/// The two hidden places of a passage, as both rigs measured them. The axes in the first are ahead,
/// left and up of the walker.
using SharedPlaces = std::array<Shared, 2>;
constexpr int kConditions = 6;  ///< Of a passage: the coordinates of both places.

/// @param slowing as of JoinOptions.
/// Nothing where hardly any point of a path is in view of two cameras of its rig.
std::optional<SharedPlaces> sharedPlaces(const geometry::Rig& first,
                                         const geometry::Rig& second,
                                         const Passage& passage,
                                         double slowing);

}  // namespace wiimote_tracker::rooms
