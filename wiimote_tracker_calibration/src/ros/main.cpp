#include "calibration_node.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  return runNode(argc, argv, "calibration", [](const auto& nh, const auto& private_nh) {
    CalibrationNode node(nh, readParameters(ParameterReader(private_nh)));
    // Services take their time, and cancel must get through meanwhile.
    spin(8);
  });
}
