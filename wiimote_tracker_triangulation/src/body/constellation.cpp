#include "body/constellation.h"

#include "body/align.h"
#include "identity/led_name.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>

namespace wiimote_tracker::body {
namespace {

// Longest distance of two LEDs of a body [m]: a larger one was not given in metres.
constexpr double kLargest = 3.0;

/// Whether a permutation of other LEDs changes the distance of two LEDs by more than a limit [m].
bool changesADistance(const std::vector<Eigen::Vector3d>& leds,
                      const std::vector<Eigen::Vector3d>& others,
                      const std::vector<std::size_t>& permutation,
                      double limit) {
  for (std::size_t i = 0; i < leds.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double change =
          (leds[i] - leds[k]).norm() - (others[permutation[i]] - others[permutation[k]]).norm();
      if (std::abs(change) > limit)
        return true;
    }
  }
  return false;
}

std::vector<std::size_t> identityOf(std::size_t size) {
  std::vector<std::size_t> permutation(size);
  std::iota(permutation.begin(), permutation.end(), std::size_t{0});
  return permutation;
}

/// The rotation that maps LEDs best onto as many others, permuted.
/// @param permutation the first to try, in lexicographic order
/// @param best is returned if no match has a smaller residual
Symmetry bestMatch(const std::vector<Eigen::Vector3d>& leds,
                   const std::vector<Eigen::Vector3d>& others,
                   std::vector<std::size_t> permutation,
                   Symmetry best) {
  const auto count = static_cast<double>(leds.size());
  do {
    // An RMS residual r of n points changes no distance by more than r sqrt(2 n).
    if (changesADistance(leds, others, permutation, best.residual * std::sqrt(2.0 * count)))
      continue;
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < leds.size(); ++i)
      pairs.push_back({leds[i], others[permutation[i]], 1.0});
    const double residual = std::sqrt(align(pairs.data(), pairs.size()).cost / count);
    if (residual < best.residual)
      best = {permutation, residual};
  } while (std::next_permutation(permutation.begin(), permutation.end()));
  return best;
}

void checkLabels(const Constellation& body) {
  const std::set<std::string> different(body.labels.begin(), body.labels.end());
  if (!body.labels.empty() &&
      (body.labels.size() != body.leds.size() || different.size() != body.labels.size()))
    throw Error("body '" + body.name + "' must have no labels, or one of its own for each of " +
                std::to_string(body.leds.size()) + " LEDs");
}

}  // namespace

void Constellation::check() const {
  if (name.empty())
    throw Error("a body has no name; give it one");
  if (!isWord(name))
    throw Error("'" + name +
                "' cannot be a body's name, which must be a letter, then letters, "
                "digits and underscores");
  if (identity::isNumbered(name))
    throw Error("'" + name + "' is the name of an LED without a label; choose another one");
  const std::string who = "body '" + name + "'";
  if (leds.size() < 3 || leds.size() > kMaximumLeds)
    throw Error(who + " has " + counted(leds.size(), "LED") + ", but must have 3 to " +
                std::to_string(kMaximumLeds));
  double breadth = 0.0;  // greatest height of a triangle above its longest side [m]
  for (std::size_t i = 0; i < leds.size(); ++i) {
    if (!leds[i].allFinite())
      throw Error(who + " has an LED whose position is not finite; correct it");
    for (std::size_t k = 0; k < i; ++k) {
      const Eigen::Vector3d side = leds[i] - leds[k];
      if (side.norm() < 0.001)
        throw Error(who + " has LEDs " + std::to_string(k) + " and " + std::to_string(i) +
                    " at one place; positions are in metres");
      if (side.norm() > kLargest)
        throw Error(who + " would be " + format("%.3g m", side.norm()) +
                    " large: give positions in metres, at most " + format("%g m", kLargest) +
                    " apart");
      for (std::size_t m = 0; m < k; ++m) {
        const Eigen::Vector3d other = leds[m] - leds[k];
        const double longest = std::max({side.norm(), other.norm(), (side - other).norm()});
        breadth = std::max(breadth, side.cross(other).norm() / longest);
      }
    }
  }
  if (breadth < 0.005)
    throw Error(who +
                " has all LEDs on one line, so that turning about it cannot be seen; "
                "move one of them off it");
  checkLabels(*this);
  const Symmetry symmetry = labels.empty() ? nearestSymmetry(*this) : Symmetry();
  if (symmetry.residual < kSymmetric)
    throw Error(describe(*this, symmetry));
}

bool operator==(const ImuMount& a, const ImuMount& b) {
  return a.topic == b.topic && a.body_from_imu.matrix() == b.body_from_imu.matrix() &&
         a.clock_offset == b.clock_offset;
}

bool operator==(const Constellation& a, const Constellation& b) {
  return a.name == b.name && a.leds == b.leds && a.labels == b.labels && a.imu == b.imu;
}

std::string Constellation::labelOf(std::size_t led) const {
  return labels.empty() ? std::to_string(led) : labels[led];
}

Symmetry nearestSymmetry(const Constellation& constellation) {
  const std::vector<Eigen::Vector3d>& leds = constellation.leds;
  std::vector<std::size_t> permutation = identityOf(leds.size());
  if (!std::next_permutation(permutation.begin(), permutation.end()))
    return {};
  return bestMatch(leds, leds, permutation, Symmetry());
}

std::string describe(const Constellation& constellation, const Symmetry& symmetry) {
  std::string exchanged;
  for (std::size_t i = 0; i < symmetry.permutation.size(); ++i) {
    if (symmetry.permutation[i] != i)
      exchanged += (exchanged.empty() ? "" : ", ") + std::to_string(i) + " for " +
                   std::to_string(symmetry.permutation[i]);
  }
  const std::string distance = format("%.1f mm", 1e3 * symmetry.residual);
  const std::string same = "body '" + constellation.name + "' looks the same within " + distance +
                           " when it is turned such that LED " + exchanged + " is taken";
  return same +
         (symmetry.residual < kSymmetric
              ? "; move an LED by some centimetres, so that its orientation can be seen, or have "
                "them blink"
              : "; orientations may be confused: move an LED, or have them blink");
}

double distanceToNearest(const std::vector<Eigen::Vector3d>& leds, std::size_t led) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < leds.size(); ++i) {
    if (i != led)
      nearest = std::min(nearest, (leds[i] - leds[led]).norm());
  }
  return nearest;
}

std::optional<std::string> describeMergingLeds(const Constellation& constellation) {
  std::optional<std::string> sentence;
  double nearest = kMerging;
  for (std::size_t i = 0; i < constellation.leds.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double distance = (constellation.leds[i] - constellation.leds[k]).norm();
      if (distance >= nearest)
        continue;
      nearest = distance;
      sentence = "body '" + constellation.name + "' has LEDs " + constellation.labelOf(k) +
                 " and " + constellation.labelOf(i) + " only " + format("%.1f mm", 1e3 * distance) +
                 " apart: their spots merge, so that it is not found or turned wrongly; move them "
                 "4 cm or more apart";
    }
  }
  return sentence;
}

std::optional<std::string> describeTwins(const Constellation& a, const Constellation& b) {
  if (a.leds.size() != b.leds.size())
    return std::nullopt;
  const Symmetry match =
      bestMatch(a.leds, b.leds, identityOf(a.leds.size()), {{}, kNearlySymmetric});
  if (match.permutation.empty())
    return std::nullopt;
  // A symmetric body is never found by its shape.
  const bool have_clear_shape =
      nearestSymmetry(a).residual >= kSymmetric || nearestSymmetry(b).residual >= kSymmetric;
  if (!have_clear_shape && a.labels != b.labels)
    return std::nullopt;
  return "bodies '" + a.name + "' and '" + b.name + "' have the same shape within " +
         format("%.1f mm", 1e3 * match.residual) +
         ": they may be taken for each other; move an LED of one of them by some centimetres";
}

}  // namespace wiimote_tracker::body
