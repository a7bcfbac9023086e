#include "benchmark_calibration_sections.h"
#include "room_trial.h"

#include <cmath>

namespace wiimote_tracker {

namespace {

void runRooms(int runs, const RowCallback& row) {
  constexpr double kDegree = M_PI / 180.0;
  CarriedLed led;
  for (const double slowing : {0.0, 0.05}) {
    led.slowing = slowing;
    for (const int passages : {4, 10, 16}) {
      const RoomErrors errors =
          errorsOfRooms(runs, [&](TwoRooms* trial) { trial->carryOften(passages, led); });
      row({format("passages %d, headings %.1f, slowing %.0f %%", passages, led.heading / kDegree,
                  100.0 * slowing),
           {{"cm", 1e2 * errors.position},
            {"stated cm", 1e2 * errors.stated_position},
            {"degrees", errors.rotation / kDegree},
            {"stated degrees", errors.stated_rotation / kDegree},
            {"nees", errors.nees}}});
    }
  }
}

}  // namespace

BenchmarkSection roomsSection() {
  return {
      "rooms",
      "two rooms joined by an LED carried through the door, hidden for 1 s; headings wander "
      "(standard deviation [degrees]); slower while hidden. RMS error at the cameras 4 m behind "
      "the door, and the stated one; NEES per parameter.",
      runRooms};
}

}  // namespace wiimote_tracker
