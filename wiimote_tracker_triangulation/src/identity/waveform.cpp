#include "wiimote_tracker_triangulation/identity/waveform.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::identity {
namespace {

double fraction(double phase) {
  return phase - std::floor(phase);
}

/// Integral of the light from phase 0 to `phase` [periods], any number.
double lightUntil(const Waveform& waveform, double phase) {
  const double whole = std::floor(phase);
  const double rest = phase - whole;
  double light = 0.0;
  for (const Lit& lit : waveform)
    light += whole * (lit.to - lit.from) + std::clamp(rest - lit.from, 0.0, lit.to - lit.from);
  return light;
}

bool isLit(const Waveform& waveform, double phase) {
  const double rest = fraction(phase);
  return std::any_of(waveform.begin(), waveform.end(),
                     [rest](const Lit& lit) { return rest >= lit.from && rest < lit.to; });
}

std::vector<double> edges(const Waveform& waveform) {
  std::vector<double> edges;
  for (const Lit& lit : waveform) {
    edges.push_back(lit.from);
    edges.push_back(lit.to);
  }
  return edges;
}

/// Lengths of the dark interval after each interval of light; zero between one that ends at 1 and
/// one that starts at 0.
std::vector<double> darkness(const Waveform& waveform) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < waveform.size(); ++i) {
    const bool last = i + 1 == waveform.size();
    lengths.push_back((last ? waveform.front().from + 1.0 : waveform[i + 1].from) - waveform[i].to);
  }
  return lengths;
}

}  // namespace

double litShare(const Waveform& waveform, double from, double length) {
  if (length <= 0.0)
    return isLit(waveform, from) ? 1.0 : 0.0;
  return (lightUntil(waveform, from + length) - lightUntil(waveform, from)) / length;
}

double longestDark(const Waveform& waveform) {
  if (waveform.empty())
    return std::numeric_limits<double>::infinity();
  const std::vector<double> lengths = darkness(waveform);
  return *std::max_element(lengths.begin(), lengths.end());
}

double shortestRun(const Waveform& waveform) {
  double shortest = 1.0;
  std::vector<double> dark = darkness(waveform);
  const bool wraps = !dark.empty() && dark.back() <= 0.0;
  for (std::size_t i = 0; i < waveform.size(); ++i) {
    if (dark[i] > 0.0)
      shortest = std::min(shortest, dark[i]);
    double light = waveform[i].to - waveform[i].from;
    if (wraps && (i == 0 || i + 1 == waveform.size()))
      light =
          waveform.front().to - waveform.front().from + waveform.back().to - waveform.back().from;
    shortest = std::min(shortest, light);
  }
  return shortest;
}

double difference(const Waveform& one, const Waveform& other, double shift) {
  std::vector<double> borders = edges(one);
  for (double edge : edges(other))
    borders.push_back(fraction(edge - shift));
  borders.push_back(0.0);
  borders.push_back(1.0);
  std::sort(borders.begin(), borders.end());
  double sum = 0.0;
  for (std::size_t i = 1; i < borders.size(); ++i) {
    const double middle = 0.5 * (borders[i - 1] + borders[i]);
    if (isLit(one, middle) != isLit(other, middle + shift))
      sum += borders[i] - borders[i - 1];
  }
  return sum;
}

double differenceInAnyRotation(const Waveform& one, const Waveform& other) {
  // Piecewise linear in the shift, with corners where two edges coincide.
  double least = difference(one, other, 0.0);
  for (double a : edges(one)) {
    for (double b : edges(other))
      least = std::min(least, difference(one, other, b - a));
  }
  return least;
}

}  // namespace wiimote_tracker::identity
