#include "suspicion.h"

#include <cstddef>
#include <utility>

namespace wiimote_tracker::bundle {

std::optional<std::string> suspicion(const Reconstruction& observed,
                                     bool intrinsics_given,
                                     const std::function<bool(const Reconstruction&)>& works) {
  const std::size_t count = observed.cameras.size();
  for (std::size_t camera = 0; camera < count; ++camera) {
    Reconstruction mirrored = observed;
    for (Observation& observation : mirrored.observations) {
      if (observation.camera == camera)
        observation.pixel.x() =
            2.0 * observed.cameras[camera].intrinsics.cx - observation.pixel.x();
    }
    if (works(mirrored))
      return "the image of " + observed.cameras[camera].name +
             " is mirrored against the others: make its x run to the right and its y down";
  }
  for (std::size_t i = 0; intrinsics_given && i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      Reconstruction exchanged = observed;
      std::swap(exchanged.cameras[i].intrinsics, exchanged.cameras[j].intrinsics);
      if (works(exchanged))
        return "the intrinsics of " + observed.cameras[i].name + " and " +
               observed.cameras[j].name + " are crossed: exchange them, or the names";
    }
  }
  return std::nullopt;
}

}  // namespace wiimote_tracker::bundle
