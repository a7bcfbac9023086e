#include "blink.h"

namespace wiimote_tracker::simulation {

double Blink::light(double time) const {
  constexpr double kExposure = 0.001;  // [s]
  return identity::litShare(waveform, (time - 0.5 * kExposure - begin) / period,
                            kExposure / period);
}

}  // namespace wiimote_tracker::simulation
