#include "driver.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  return wiimote_tracker::runNode<wiimote_tracker::driver::Driver>(
      argc, argv, "driver",
      "Opens one Wii Remote and publishes what its camera sees, as _device:=ADDRESS says.\n"
      "Parameters, with units, ranges and defaults:\n"
      "  less $(rospack find wiimote_tracker_driver)/config/driver.yaml");
}
