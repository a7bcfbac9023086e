#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H

#include "node_context.h"

#include <optional>

namespace wiimote_tracker {

/// A wand as a request gives it: a length of 0 means none, a standard deviation of 0 the usual one.
std::optional<wave::Wand> wandOf(double length, double stddev);

/// Begins to record a wave of the run that is started. @param wand nothing: one LED is waved.
/// @throws Refusal as NodeContext::samples(), or when another request changed the run meanwhile.
workflow::Reply beginWave(const std::optional<wave::Wand>& wand, NodeContext* context, Lock* lock);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_WAVE_SERVICES_H
