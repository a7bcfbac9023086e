#include "gestures.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  return wiimote_tracker::runNode<wiimote_tracker::Gestures>(
      argc, argv, "gestures",
      "Recognises gestures of tracked LEDs.\n"
      "Parameters, with units, ranges and defaults:\n"
      "  less $(rospack find wiimote_tracker_triangulation)/config/gestures.yaml");
}
