#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_MERGED_SPOT_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_MERGED_SPOT_H

#include "motion/pixel_prediction.h"

#include <Eigen/Core>

namespace wiimote_tracker::tracking {

/// Probability [0..1] that a spot is that of two merged LEDs, rather than of one while the other is
/// hidden. A merged spot is between both predictions, a single one at its own. The distance below
/// which two LEDs merge is uniform up to a limit, as far as we know.
/// @param visible, absent predictions of the LED that the spot was assigned to, and of the other
/// @param hidden prior probability that the absent one is hidden [0..1, exclusive]
/// @param pixel_stddev of the spot [px]  @param merging_distance see TrackerOptions [px]
double mergedProbability(const Eigen::Vector2d& spot,
                         const motion::PixelPrediction& visible,
                         const motion::PixelPrediction& absent,
                         double hidden,
                         double pixel_stddev,
                         double merging_distance);

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_MERGED_SPOT_H
