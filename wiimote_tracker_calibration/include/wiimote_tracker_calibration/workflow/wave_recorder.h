#ifndef WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_WAVE_RECORDER_H
#define WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_WAVE_RECORDER_H

#include "wiimote_tracker_calibration/capture/image.h"
#include "wiimote_tracker_calibration/wave/coverage.h"
#include "wiimote_tracker_calibration/wave/recording.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

/// Records what all cameras see while an LED or a wand is waved, and says how far the wave is.
class WaveRecorder {
 public:
  /// Longest wave [s]; what comes later is not recorded.
  static constexpr double kLongest = 600.0;

  /// What one camera saw; all stamps are of one clock epoch.
  struct Track {
    std::uint32_t clock_epoch = 0;
    std::vector<wave::Frame> frames;
    bool reconnected = false;  ///< Its clock began anew in between; what it saw before was dropped.
  };

  /// @param cameras names and image sizes, poses if `posed`. @param wand nothing: one LED is waved.
  /// @param start images from before are not recorded [s].
  /// @throws wave::WaveError: options out of range.
  WaveRecorder(const std::vector<geometry::Camera>& cameras,
               bool posed,
               const std::optional<wave::Wand>& wand,
               const wave::CoverageOptions& options,
               double start);

  /// One image. Ignored for unknown cameras, and when it is not later than the one before.
  void add(const capture::Image& image);

  const std::optional<wave::Wand>& wand() const { return wand_; }
  /// Nothing for unknown cameras.
  const Track* track(const std::string& camera) const;
  /// Missing: with cameras that connected anew.
  wave::CoverageReport report() const;
  /// How long it takes at least [s].
  double secondsNeeded() const { return options_.seconds; }

 private:
  std::vector<geometry::Camera> cameras_;
  bool posed_;
  std::optional<wave::Wand> wand_;
  wave::CoverageOptions options_;
  double start_;
  std::map<std::string, std::size_t> index_;
  std::vector<Track> tracks_;
  wave::Coverage coverage_;
};

}  // namespace wiimote_tracker::workflow

#endif  // WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_WAVE_RECORDER_H
