#include "clock_reading.h"

#include <chrono>
#include <limits>

namespace wiimote_tracker::driver {
namespace {

// Readings up to this long were certainly not interrupted [s].
constexpr double kUninterrupted = 1e-5;
constexpr int kAttempts = 3;

}  // namespace

double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

ClockReading readClocks() {
  ClockReading reading;
  reading.steady = steadyNow();
  reading.simulated = ros::Time::isSimTime();
  if (reading.simulated) {
    reading.ros = ros::Time::now();
    return reading;
  }
  reading.uncertainty = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kAttempts && reading.uncertainty > kUninterrupted; ++i) {
    const double before = steadyNow();
    const ros::Time ros = ros::Time::now();
    const double after = steadyNow();
    if (after - before < reading.uncertainty) {
      reading.uncertainty = after - before;
      reading.ros = ros - ros::Duration(0.5 * (before + after) - reading.steady);
    }
  }
  return reading;
}

}  // namespace wiimote_tracker::driver
