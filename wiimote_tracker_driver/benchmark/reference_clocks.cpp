#include "reference_clocks.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr double kNominalPeriod = 0.010035;
constexpr double kTolerance = 500e-6;

double kalman(const SimulatedSession& session, const LinkModel& link) {
  const double noise = link.spread * link.spread + link.slot * link.slot / 12.0;
  const double wander = link.wander * link.wander / 10.0 * kNominalPeriod;  // per frame
  const SimulatedReport& first = session.reports.front();
  // Relative to the nominal period.
  double time = 0.0, period = 0.0;
  double p00 = 1.0, p01 = 0.0, p11 = std::pow(kNominalPeriod * kTolerance, 2) / 3.0;
  std::int64_t frame = first.frame;
  for (const SimulatedReport& report : session.reports) {
    const auto n = static_cast<double>(report.frame - frame);
    frame = report.frame;
    time += n * period;
    p00 += 2.0 * n * p01 + n * n * p11 + wander * n;
    p01 += n * p11;
    if (report.queued)
      continue;
    const double innovation = report.arrival - first.arrival -
                              static_cast<double>(frame - first.frame) * kNominalPeriod - time;
    const double g0 = p00 / (p00 + noise), g1 = p01 / (p00 + noise);
    time += g0 * innovation;
    period += g1 * innovation;
    p11 -= g1 * p01;
    p00 -= g0 * p00;
    p01 -= g0 * p01;
  }
  return first.arrival + static_cast<double>(frame - first.frame) * kNominalPeriod + time;
}

// Histogram of the phase around the true first one; the period is known.
double pointMass(const SimulatedSession& session, const LinkModel& link) {
  constexpr double kCell = 10e-6;
  constexpr int kHalf = 700;
  constexpr int kCells = 2 * kHalf + 1;
  std::vector<double> mass(kCells, 1.0), spread(kCells);
  const SimulatedReport& first = session.reports.front();
  const double start = first.exposure + link.least_delay;
  const auto readyBefore = [&](double late) {
    return late > 0.0 ? -std::expm1(-late / link.spread) : 0.0;
  };
  std::int64_t frame = first.frame;
  for (const SimulatedReport& report : session.reports) {
    const double sd = link.wander *
                      std::sqrt(static_cast<double>(report.frame - frame) * kNominalPeriod / 10.0) /
                      kCell;
    frame = report.frame;
    if (sd > 0.0) {
      const int reach = static_cast<int>(std::ceil(4.0 * sd));
      std::fill(spread.begin(), spread.end(), 0.0);
      for (int d = -reach; d <= reach; ++d) {
        const double weight = std::exp(-0.5 * d * d / (sd * sd));
        for (int i = std::max(0, -d); i < std::min(kCells, kCells - d); ++i)
          spread[i + d] += weight * mass[i];
      }
      mass.swap(spread);
    }
    const double base =
        start + static_cast<double>(frame - first.frame) * session.period - kHalf * kCell;
    double sum = 0.0;
    for (int i = 0; i < kCells; ++i) {
      const double late = report.arrival - base - i * kCell;
      if (report.queued)
        mass[i] *= readyBefore(late);
      else if (link.slot > 0.0)
        mass[i] *= readyBefore(late) - readyBefore(late - link.slot);
      else
        mass[i] *= late > 0.0 ? std::exp(-late / link.spread) : 0.0;
      sum += mass[i];
    }
    for (double& m : mass)
      m /= sum;
  }
  double mean = 0.0;
  for (int i = 0; i < kCells; ++i)
    mean += mass[i] * (i - kHalf) * kCell;
  return start + static_cast<double>(frame - first.frame) * session.period + mean;
}
}  // namespace

double leastSquares(const SimulatedSession& session) {
  const SimulatedReport& last = session.reports.back();
  double n = 0.0, k = 0.0, a = 0.0, kk = 0.0, ka = 0.0;
  for (const SimulatedReport& report : session.reports) {
    const auto x = static_cast<double>(report.frame - last.frame);
    const double y = report.arrival - last.arrival;
    n += 1.0;
    k += x;
    a += y;
    kk += x * x;
    ka += x * y;
  }
  const double slope = (n * ka - k * a) / (n * kk - k * k);
  return last.arrival + (a - slope * k) / n;
}

double convexHull(const SimulatedSession& session) {
  const SimulatedReport& last = session.reports.back();
  std::vector<std::pair<double, double>> hull;
  double mean = 0.0;
  for (const SimulatedReport& report : session.reports) {
    const std::pair<double, double> p(static_cast<double>(report.frame - last.frame),
                                      report.arrival - last.arrival);
    mean += p.first / static_cast<double>(session.reports.size());
    const auto bulges = [&] {
      const auto &a = hull[hull.size() - 2], &b = hull.back();
      return (b.first - a.first) * (p.second - a.second) <=
             (b.second - a.second) * (p.first - a.first);
    };
    while (hull.size() > 1 && bulges())
      hull.pop_back();
    hull.push_back(p);
  }
  std::size_t i = 0;
  while (i + 2 < hull.size() && hull[i + 1].first < mean)
    ++i;
  const double slope = (hull[i + 1].second - hull[i].second) / (hull[i + 1].first - hull[i].first);
  return last.arrival + hull[i].second - slope * hull[i].first;
}

double olson(const SimulatedSession& session) {
  const SimulatedReport& first = session.reports.front();
  double offset = 0.0, device = 0.0;
  for (const SimulatedReport& report : session.reports) {
    const double now = static_cast<double>(report.frame - first.frame) * kNominalPeriod;
    offset = std::min(offset + kTolerance * (now - device), report.arrival - first.arrival - now);
    device = now;
  }
  return first.arrival + device + offset;
}

double oracle(const SimulatedSession& session, const LinkModel& link) {
  return link.core == LinkModel::Core::kBell ? kalman(session, link) : pointMass(session, link);
}

}  // namespace wiimote_tracker::exposure_clock
