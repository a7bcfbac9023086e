#include "calibration_node.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  return runNode(
      argc, argv, "calibration",
      "Calibrates the cameras, as the program calibrate or the panel of rviz asks it to.\n"
      "Parameters, with units, ranges and defaults:\n"
      "  less $(rospack find wiimote_tracker_calibration)/config/calibration.yaml",
      [](const auto& nh, const auto& private_nh) {
        CalibrationNode node(nh, readParameters(ParameterReader(private_nh)));
        // Services take their time, and cancel must get through meanwhile.
        spin(8);
      });
}
