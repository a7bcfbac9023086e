#include "rig_output.h"

#include <wiimote_tracker_triangulation/ros/conversions.h>

namespace wiimote_tracker {

RigOutput::RigOutput(ros::NodeHandle nh)
    : publisher_(nh.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 1, true)) {}

void RigOutput::publish(const geometry::Rig& rig) {
  // The transforms first: who hears of the rig finds them.
  broadcaster_.sendTransform(staticTransforms(rig));
  publisher_.publish(toMessage(rig));
}

}  // namespace wiimote_tracker
