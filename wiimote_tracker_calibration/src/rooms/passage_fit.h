#pragma once

#include "rooms/rig_motion.h"
#include "rooms/shared_places.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::rooms {

using PassageIndices = std::vector<std::size_t>;

/// Errors of passages over those of the model, ahead, to the left and up [1].
using Scatter = Eigen::Vector3d;

/// The least squares problem: which motion between two rooms fits best to passages.
class PassageProblem {
 public:
  /// @param first, second not owned. @param vertical shared by both worlds, if any.
  PassageProblem(const geometry::Rig& first,
                 const geometry::Rig& second,
                 const std::vector<SharedPlaces>& passages,
                 const std::optional<Shared>& vertical)
      : first_(first), second_(second), passages_(passages), vertical_(vertical) {}

  std::size_t size() const { return passages_.size(); }

  /// The motion that brings the places nearest to each other, all of the same weight.
  /// @throws Error: all are on one line.
  Eigen::Isometry3d start() const;

  /// @param scatters of each passage
  RigMotion fit(const PassageIndices& used,
                const Eigen::Isometry3d& start,
                const std::vector<Scatter>& scatters) const;

  /// All of the same scatter.
  RigMotion fit(const PassageIndices& used,
                const Eigen::Isometry3d& start,
                const Scatter& scatter) const {
    return fit(used, start, std::vector<Scatter>(size(), scatter));
  }

  /// Mean squared misfit of each passage over that of the model [1].
  std::vector<double> misfits(const Eigen::Isometry3d& motion) const;

  /// That the passages show which the motion was fitted to, and the model.
  Scatter scatter(const PassageIndices& used, const RigMotion& motion) const;

 private:
  const geometry::Rig& first_;
  const geometry::Rig& second_;
  std::vector<SharedPlaces> passages_;
  std::optional<Shared> vertical_;
};

/// The motion that fits best.
struct PassageFit {
  RigMotion motion;
  Scatter scatter;
  PassageIndices used;  ///< The passages that agree, at least two thirds.
};

/// @throws Error: the passages contradict one another, or leave the motion open.
PassageFit fitPassages(const PassageProblem& problem);

}  // namespace wiimote_tracker::rooms
