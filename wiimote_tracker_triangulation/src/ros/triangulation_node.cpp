#include "triangulation.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  return wiimote_tracker::runNode(argc, argv, "triangulation",
                                  [](const auto& nh, const auto& private_nh) {
                                    wiimote_tracker::Triangulation triangulation(nh, private_nh);
                                    wiimote_tracker::spin();
                                  });
}
