#include "wiimote_tracker_calibration/bundle/solve.h"

#include "start.h"
#include "steps.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <string>

namespace wiimote_tracker::bundle {

namespace {

std::string commonText(const NormalizedViews& views, const Reconstruction& reconstruction) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = i + 1; j < views.size(); ++j)
      texts.push_back(format("%s and %s %zu", reconstruction.cameras[i].name.c_str(),
                             reconstruction.cameras[j].name.c_str(),
                             commonViews(views[i], views[j]).first.size()));
  }
  return joined(texts);
}

void startFromPair(const Options& options, Reconstruction* reconstruction) {
  for (const CameraPair& pair : likelyPairs(*reconstruction, options)) {
    if (placePair(options, pair, reconstruction))
      return;
  }
  throw BundleError("no two cameras agree on where they stand; they need " +
                    std::to_string(options.minimum_common_points) +
                    " or more points in common, spread over the room, and have: " +
                    commonText(normalize(*reconstruction), *reconstruction));
}

}  // namespace

Reconstruction solve(Reconstruction reconstruction, const Options& options) {
  checkObservations(reconstruction);
  std::vector<bool>& placed = reconstruction.placed;
  placed.assign(reconstruction.cameras.size(), false);
  startFromPair(options, &reconstruction);
  while (true) {
    triangulatePoints(&reconstruction, kStartTolerance * options.maximum_error, placed);
    const bool all_placed = std::find(placed.begin(), placed.end(), false) == placed.end();
    Options now = options;
    now.rough = options.rough || !all_placed;
    now.fixed_lenses = true;
    adjust(&reconstruction, now);
    if (all_placed)
      break;
    resect(options, nextToResect(options, reconstruction), &reconstruction);
  }
  refuseUnexplained(reconstruction, options);
  return reconstruction;
}

}  // namespace wiimote_tracker::bundle
