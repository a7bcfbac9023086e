#include "motion/transition.h"

#include <cmath>

namespace wiimote_tracker::motion {
namespace {

/// The closed forms of the Singer model for a time of 1 s and a variance of 1, over a duration x.
struct UnitSinger {
  double f_pa, f_aa;
  double q_pp, q_pv, q_pa, q_vv;
};

UnitSinger closedForm(double x) {
  const double e = std::exp(-x);
  const double x2 = x * x;
  UnitSinger result;
  result.f_pa = x - 1.0 + e;
  result.f_aa = e;
  result.q_pp = 1.0 - e * e + 2.0 * x + 2.0 / 3.0 * x2 * x - 2.0 * x2 - 4.0 * x * e;
  result.q_pv = e * e + 1.0 - 2.0 * e + 2.0 * x * e - 2.0 * x + x2;
  result.q_pa = 1.0 - e * e - 2.0 * x * e;
  result.q_vv = 4.0 * e - 3.0 - e * e + 2.0 * x;
  return result;
}

/// The same by the power series of the exponentials, without the terms that cancel: for small x the
/// closed forms subtract nearly equal numbers.
UnitSinger series(double x) {
  constexpr int kTerms = 18;
  constexpr double kNegligible = 1e-15;
  UnitSinger result{};
  double term = 0.5 * x * x;  // (-x)^n / n!
  double power = 4.0;         // 2^n
  result.f_pa = term;
  for (int n = 3; n <= kTerms; ++n) {
    term *= -x / n;
    power *= 2.0;
    result.f_pa += term;
    result.q_vv += term * (4.0 - power);
    result.q_pa += term * (2.0 * n - power);
    if (n >= 4)
      result.q_pv += term * (power - 2.0 - 2.0 * n);
    if (n >= 5) {
      const double change = term * (4.0 * n - power);
      result.q_pp += change;
      if (std::abs(change) < kNegligible * result.q_pp)
        break;  // the other sums converge faster
    }
  }
  result.f_aa = 1.0 - x + result.f_pa;
  return result;
}

Eigen::Matrix3d symmetric(double pp, double pv, double pa, double vv, double va, double aa) {
  Eigen::Matrix3d result;
  result << pp, pv, pa, pv, vv, va, pa, va, aa;
  return result;
}

}  // namespace

Transition singer(double stddev, double time, double duration) {
  const double x = duration / time;
  const UnitSinger unit = x < 0.5 ? series(x) : closedForm(x);
  const double lost = x - unit.f_pa;  // 1 - f_aa without loss of digits
  const double time2 = time * time;
  Transition result;
  result.F << 1.0, duration, time2 * unit.f_pa, 0.0, 1.0, time * lost, 0.0, 0.0, unit.f_aa;
  result.Q = stddev * stddev *
             symmetric(time2 * time2 * unit.q_pp, time2 * time * unit.q_pv, time2 * unit.q_pa,
                       time2 * unit.q_vv, time * lost * lost, lost * (1.0 + unit.f_aa));
  return result;
}

Transition randomWalkOfVelocity(double density, double duration) {
  const double variance = density * density * duration;
  Transition result;
  result.F << 1.0, duration, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0;
  result.Q = symmetric(variance * duration * duration / 3.0, variance * duration / 2.0, 0.0,
                       variance, 0.0, 0.0);
  return result;
}

}  // namespace wiimote_tracker::motion
