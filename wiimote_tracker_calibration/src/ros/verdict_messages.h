#pragma once

#include "samples/verdict.h"
#include "wiimote_tracker_calibration/principal_point/correction.h"

#include <wiimote_tracker_msgs/CalibrationVerdict.h>
#include <wiimote_tracker_msgs/PrincipalPointTrace.h>
#include <wiimote_tracker_triangulation/geometry/rig.h>

namespace wiimote_tracker {

wiimote_tracker_msgs::CalibrationVerdict toMessage(const samples::Verdict& verdict,
                                                   const geometry::Rig& rig);

wiimote_tracker_msgs::PrincipalPointTrace toMessage(const principal_point::Trace& trace,
                                                    const geometry::Rig& rig);

}  // namespace wiimote_tracker
