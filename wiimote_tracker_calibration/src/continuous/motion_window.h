#pragma once

#include "capture/image.h"

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {

/// How much motion a solution takes. It is counted in samples, at most 20 a second, in which
/// several cameras see one spot that has moved.
struct MotionOptions {
  std::size_t to_solve = 0;  ///< Samples [> 0].
  /// Later samples, which the solution does not use [>= 40: fewer are not judged, see driftOf() in
  /// health/drift_residuals.h].
  std::size_t to_check = 0;
  /// Samples, to which these grow while the motion goes on; below to_solve: they do not grow.
  std::size_t most_to_solve = 0;
  std::size_t cameras = 3;  ///< That must see the LED in a sample [>= 1].
};

/// Images of all cameras while an LED moved.
struct MotionImages {
  std::vector<capture::Image> to_solve;
  std::vector<capture::Image> to_check;  ///< Later ones.
};

/// Keeps the latest images while an LED moves, for an hour at most.
class MotionWindow {
 public:
  explicit MotionWindow(const MotionOptions& options) : options_(options) {}

  /// One image; of one camera in the order of their stamps.
  /// @param needed camera without which no sample counts; empty: none.
  /// @returns whether there is enough, and enough new motion since it was the last time.
  bool add(const capture::Image& image, const std::string& needed = "");

  MotionImages images() const;

  void clear();

 private:
  void count(const capture::Image& image, const std::string& needed);

  MotionOptions options_;
  std::map<std::string, Eigen::Vector2d> spots_;  // Each camera's spot in its latest sample [px].
  double period_ = 0.0;                           // Of the sample that begins [s].
  std::set<std::string> moved_;                   // Cameras in it.
  std::deque<capture::Image> images_;
  std::deque<double> samples_;  // Stamps [s].
  std::size_t unused_ = 0;      // Samples since there was enough.
};

}  // namespace wiimote_tracker::continuous
