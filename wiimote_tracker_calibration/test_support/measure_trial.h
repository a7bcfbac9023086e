#pragma once

#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include "samples/verdict.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::samples {

/// A solution, held against the truth at the verdict's places.
struct MeasureStep {
  double expected = 0.0;                ///< RMS error as the verdict says [m].
  double error = 0.0;                   ///< RMS error [m].
  double shape = 0.0;                   ///< Expected after the best rigid motion, RMS [m].
  std::optional<NextMeasurement> next;  ///< That was done for the following step.
};

/// A simulated session in which a person follows the verdict's advice up to `measurements` times,
/// as exact as TapedLength and KnownPlace say. A scene of 0 s has no wave.
/// @throws geometry::Error: a solution was refused.
std::vector<MeasureStep> runMeasureTrial(const wave::WaveScene& scene,
                                         std::uint64_t seed,
                                         int measurements);

}  // namespace wiimote_tracker::samples
