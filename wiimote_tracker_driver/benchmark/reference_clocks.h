#pragma once

#include "simulated_link.h"

namespace wiimote_tracker::exposure_clock {

// Other estimators of the last report's exposure time [s], late by a constant. They use the frame
// numbers of the session, which a real receiver does not have.

/// Straight line through all arrivals.
double leastSquares(const SimulatedSession& session);

/// Support line under all arrivals at the mean frame: the edge of the convex hull (Zhang, Liu, Xia,
/// INFOCOM 2002).
double convexHull(const SimulatedSession& session);

/// A lower bound: knows spread, wander, slots and which reports were queued. For normal delays a
/// Kalman filter that does not know the period; for exponential ones a point-mass filter that does.
double oracle(const SimulatedSession& session, const LinkModel& link);

}  // namespace wiimote_tracker::exposure_clock
