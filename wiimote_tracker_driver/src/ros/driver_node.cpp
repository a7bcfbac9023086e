#include "driver.h"

#include <wiimote_tracker_msgs/run_node.h>

int main(int argc, char** argv) {
  return wiimote_tracker::runNode(argc, argv, "driver", [](const auto& nh, const auto& private_nh) {
    const wiimote_tracker::driver::Driver driver(nh, private_nh);
    wiimote_tracker::spin();
  });
}
