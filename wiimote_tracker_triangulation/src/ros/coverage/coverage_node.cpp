#include "coverage_display.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  return wiimote_tracker::runNode<wiimote_tracker::CoverageDisplay>(
      argc, argv, "coverage",
      "Shows in rviz where the cameras see an LED, and how accurately.\n"
      "Parameters, with units, ranges and defaults:\n"
      "  less $(rospack find wiimote_tracker_triangulation)/config/coverage.yaml");
}
