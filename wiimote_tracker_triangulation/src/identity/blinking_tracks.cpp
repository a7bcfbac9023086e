#include "wiimote_tracker_triangulation/identity/blinking_tracks.h"

#include <algorithm>

namespace wiimote_tracker::identity {

tracking::TrackerOptions forBlinking(const BlinkCodes& codes, tracking::TrackerOptions options) {
  double light = 0.0;
  for (const BlinkCode& code : codes.codes)
    light += litShare(code.waveform, 0.0, 1.0) / static_cast<double>(codes.codes.size());
  options.dark_time = codes.longestDark();
  options.prediction_time = std::max(options.prediction_time, 2.0 * options.dark_time);
  options.detection_probability *= light;
  return options;
}

}  // namespace wiimote_tracker::identity
