#pragma once

#include "capture/image.h"
#include "capture/views.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::continuous {

using capture::View;

/// The LED at one instant, as three cameras or more see it.
struct Keyframe {
  Eigen::Vector3d point;  ///< World [m].
  /// On the LED's curve; the error of a velocity is independent of the pixel's, but beside a gap.
  std::vector<View> views;
  double squared = 0.0;  ///< Sum of the squared residuals [px^2].
};

/// The images of a moving LED, and keyframes of them.
class KeyframeSource {
 public:
  /// Uses images with exactly one spot, not counting lamps, and of each camera's latest epoch only.
  KeyframeSource(const geometry::Rig& rig, const std::vector<capture::Image>& images);

  /// Latest epoch of a camera's clock; nothing without an image of it.
  std::optional<std::uint32_t> epoch(std::size_t camera) const;

  /// At most 20 a second, in which the LED is somewhere else each time.
  /// @param rig with the time offsets of these images.
  /// @param gate largest root mean square of the residuals of a keyframe [px]. One view that
  /// exceeds it is left out, if three others agree.
  std::vector<Keyframe> keyframes(const geometry::Rig& rig, double gate) const;

 private:
  struct Track {
    std::optional<std::uint32_t> epoch;
    std::vector<capture::Spot> spots;  // By the camera's clock.
  };

  /// When any camera sees its next spot after a time; infinite: never [s].
  double nextSpot(const geometry::Rig& rig, double time) const;

  std::vector<Track> tracks_;  // Per camera of the rig.
};

constexpr std::size_t kLeastKeyframes = 40;  ///< As DriftWatch needs for a judgement.

/// Root mean square of the residuals per axis, corrected for the points that were fitted [px].
double rmsResidual(const std::vector<Keyframe>& keyframes);

/// How well images fit together.
struct Fit {
  double misfit;                        ///< Root mean square of the residuals per axis [px].
  std::vector<Eigen::Vector3d> places;  ///< Where the LED was, world [m].
};

/// The fit of the images of each camera's latest epoch, with the time offsets that hold then.
/// Nothing when three cameras agree on too few places.
std::optional<Fit> fitOf(const geometry::Rig& rig, const std::vector<capture::Image>& images);

}  // namespace wiimote_tracker::continuous
