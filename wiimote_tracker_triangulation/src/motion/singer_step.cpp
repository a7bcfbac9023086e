#include "wiimote_tracker_triangulation/motion/singer_step.h"

#include <cmath>

namespace wiimote_tracker::motion {
namespace {

/// The closed forms are differences of nearly equal numbers below this share of the acceleration
/// time; there the series of the exponentials are summed from the first term that does not cancel.
constexpr double kSeriesBelow = 0.5;

constexpr int kTerms = 18;
constexpr double kNegligible = 1e-15;
constexpr double kInverse[kTerms + 1] = {0.0,      1.0,      1.0 / 2,  1.0 / 3,  1.0 / 4,
                                         1.0 / 5,  1.0 / 6,  1.0 / 7,  1.0 / 8,  1.0 / 9,
                                         1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13, 1.0 / 14,
                                         1.0 / 15, 1.0 / 16, 1.0 / 17, 1.0 / 18};

}  // namespace

SingerStep::SingerStep(double duration, double acceleration_time) {
  const double x = duration / acceleration_time;
  const double x2 = x * x;
  if (x < kSeriesBelow) {
    p_a = 0.5 * x2;
    q_pp = q_pv = q_pa = q_vv = 0.0;
    double term = 0.5 * x2;  // (-x)^n / n!
    double power = 4.0;      // 2^n
    for (int n = 3; n <= kTerms; ++n) {
      term *= -x * kInverse[n];
      power *= 2.0;
      p_a += term;
      q_vv += term * (4.0 - power);
      q_pa += term * (2.0 * n - power);
      if (n >= 4)
        q_pv += term * (power - 2.0 - 2.0 * n);
      if (n >= 5) {
        const double change = term * (4.0 * n - power);
        q_pp += change;
        if (std::abs(change) < kNegligible * q_pp)
          break;  // the others go faster
      }
    }
    a_a = 1.0 - x + p_a;
  } else {
    const double e = std::exp(-x);
    p_a = x - 1.0 + e;
    a_a = e;
    q_pp = 1.0 - e * e + 2.0 * x + 2.0 / 3.0 * x2 * x - 2.0 * x2 - 4.0 * x * e;
    q_pv = e * e + 1.0 - 2.0 * e + 2.0 * x * e - 2.0 * x + x2;
    q_pa = 1.0 - e * e - 2.0 * x * e;
    q_vv = 4.0 * e - 3.0 - e * e + 2.0 * x;
  }
  const double lost = x - p_a;  // 1 - a_a, of which the difference would lose digits
  const double time2 = acceleration_time * acceleration_time;
  p_v = duration;
  p_a *= time2;
  v_a = acceleration_time * lost;
  q_pp *= time2 * time2;
  q_pv *= time2 * acceleration_time;
  q_pa *= time2;
  q_vv *= time2;
  q_va = acceleration_time * lost * lost;
  q_aa = lost * (1.0 + a_a);
}

}  // namespace wiimote_tracker::motion
