#include "gestures.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  return wiimote_tracker::runNode(argc, argv, "gestures",
                                  [](const auto& nh, const auto& private_nh) {
                                    wiimote_tracker::Gestures gestures(nh, private_nh);
                                    wiimote_tracker::spin();
                                  });
}
