#include "triangulation.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  return wiimote_tracker::runNode<wiimote_tracker::Triangulation>(
      argc, argv, "triangulation",
      "Tracks LEDs in space: computes their positions from the cameras' images.\n"
      "Parameters, with units, ranges and defaults:\n"
      "  less $(rospack find wiimote_tracker_triangulation)/config/triangulation.yaml");
}
