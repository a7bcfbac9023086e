#pragma once

#include "capture/image.h"
#include "wave/coverage.h"
#include "wave/wand_rest.h"
#include "wiimote_tracker_calibration/wave/recording.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

/// Records the images of all cameras while an LED or a wand is waved, and reports its coverage.
class WaveRecorder {
 public:
  /// Longest wave [s]; later images are not recorded.
  static constexpr double kLongest = 600.0;

  /// What one camera saw; all stamps are of one clock epoch.
  struct Track {
    std::uint32_t clock_epoch = 0;
    std::vector<wave::Frame> frames;
    wave::WandRest rest;
    bool reconnected = false;  ///< Its clock started again; the earlier images were dropped.
  };

  /// @param cameras names and image sizes, poses if `posed`. @param wand nothing: one LED is waved.
  /// @param start earlier images are not recorded [s].
  WaveRecorder(const std::vector<geometry::Camera>& cameras,
               bool posed,
               const std::optional<wave::Wand>& wand,
               const wave::CoverageOptions& options,
               double start);

  /// One image. Ignored for unknown cameras, and if it is not later than the camera's last one.
  /// @returns whether it was the last one that needsFloor() waited for.
  bool add(const capture::Image& image);

  const std::optional<wave::Wand>& wand() const { return wand_; }
  /// Whether the wand must still lie on the floor: two cameras have not seen it at rest.
  bool needsFloor() const;
  /// Nothing for unknown cameras.
  const Track* track(const std::string& camera) const;
  /// The coverage; what is missing names the wand on the floor and cameras that reconnected, too.
  wave::CoverageReport report() const;
  /// Shortest wave [s].
  double secondsNeeded() const { return options_.seconds; }

 private:
  std::optional<wave::Wand> wand_;
  wave::CoverageOptions options_;
  double start_;
  std::map<std::string, std::size_t> index_;
  std::vector<Track> tracks_;
  wave::Coverage coverage_;
};

}  // namespace wiimote_tracker::workflow
