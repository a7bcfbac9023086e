#include "coverage_display.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  return wiimote_tracker::runNode(argc, argv, "coverage",
                                  [](const auto& nh, const auto& private_nh) {
                                    wiimote_tracker::CoverageDisplay display(nh, private_nh);
                                    wiimote_tracker::spin();
                                  });
}
