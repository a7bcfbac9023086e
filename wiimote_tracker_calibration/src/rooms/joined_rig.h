#pragma once

#include "rooms/rig_motion.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <limits>
#include <string>

namespace wiimote_tracker::rooms {

/// @throws Error: both are the same rig, or the second adds no camera; a rig without covariance;
/// different ray models; a camera or device that has two names.
void checkRigs(const geometry::Rig& first, const geometry::Rig& second);

/// Offset of the second rig's clock from the first's.
struct ClockShift {
  double shift = std::numeric_limits<double>::quiet_NaN();  ///< [s]; NaN: not known.
  Eigen::RowVectorXd by_errors;  ///< By the errors of the parameters of both rigs.
};

/// From shared cameras with known time offsets.
ClockShift clockShift(const geometry::Rig& first, const geometry::Rig& second);

/// The first rig with the second's other cameras, moved into its world, without corrections of the
/// volume. The joint covariance is to first order. The verdict is left to the caller
/// (joinedVerdict()).
/// @throws geometry::InvalidRigError as Rig::check().
geometry::Rig joinedRig(const geometry::Rig& first,
                        const geometry::Rig& second,
                        const RigMotion& motion,
                        const ClockShift& clock);

/// A clause about what of two rigs joinedRig() leaves out, and what to do; empty: nothing.
std::string lostByJoining(const geometry::Rig& first, const geometry::Rig& second);

/// That of a joined rig, which is no better than its parts. @param message how they were joined.
std::string joinedVerdict(const geometry::Rig& first,
                          const geometry::Rig& second,
                          const std::string& message);

}  // namespace wiimote_tracker::rooms
