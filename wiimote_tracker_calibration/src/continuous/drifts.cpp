#include "continuous/drifts.h"

#include <algorithm>

namespace wiimote_tracker::continuous {

Drifts driftsOf(const geometry::Rig& rig, const std::vector<capture::Image>& images) {
  health::DriftOptions options;
  // So long that nothing is judged before the end.
  options.window = 100.0 * (images.back().stamp - images.front().stamp);
  health::DriftWatch watch(rig, options);
  for (const capture::Image& image : images)
    watch.add(image);
  watch.judge();
  return watch.drifts();
}

bool allFit(const Drifts& drifts, std::ptrdiff_t cameras) {
  const auto judged = std::count_if(drifts.begin(), drifts.end(),
                                    [](const auto& drift) { return drift.has_value(); });
  return judged >= cameras && std::none_of(drifts.begin(), drifts.end(), [](const auto& drift) {
           return drift && drift->ratio >= 1.0;
         });
}

}  // namespace wiimote_tracker::continuous
