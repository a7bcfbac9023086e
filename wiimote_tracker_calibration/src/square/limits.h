#pragma once

namespace wiimote_tracker::square {

// Beyond these a calibration, by a square or a wave, contradicts what is stated and is refused.
constexpr double kRefuseRatio = 4.0;   ///< Residuals over the stated errors [1].
constexpr double kLensLimit = 5.0;     ///< Lens from its start [standard deviations].
constexpr double kGravityLimit = 5.0;  ///< Gravity from the normal of the floor, the same.

}  // namespace wiimote_tracker::square
