#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_SINGER_STEP_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_SINGER_STEP_H

namespace wiimote_tracker::motion {

/// What passes in each axis over a duration when the acceleration a is a stationary first-order
/// Markov process, da = -a / time dt + noise (R. A. Singer, "Estimating optimal tracking filter
/// performance for manned maneuvering targets", IEEE Trans. AES 6(4), 1970):
///   p' = p + p_v v + p_a a,  v' = v + v_a a,  a' = a_a a,
/// plus noise whose covariance is that of the fields q_.. times the acceleration's variance.
struct SingerStep {
  /// @param duration [s, >= 0]  @param acceleration_time [s, > 0]
  SingerStep(double duration, double acceleration_time);

  double p_v;                                 ///< [s]
  double p_a;                                 ///< [s^2]
  double v_a;                                 ///< [s]
  double a_a;                                 ///< [1]
  double q_pp, q_pv, q_pa, q_vv, q_va, q_aa;  ///< [s^4], [s^3], [s^2], [s^2], [s], [1]
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_SINGER_STEP_H
