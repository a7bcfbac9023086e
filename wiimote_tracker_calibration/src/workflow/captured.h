#pragma once

#include "capture/corner_capture.h"
#include "capture/masks.h"
#include "samples/samples.h"
#include "wave/coverage.h"
#include "workflow/reply.h"
#include "workflow/square_run.h"
#include "workflow/wave_recorder.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

/// Facts about cameras besides where they saw the LED, by name.
using CameraFacts = std::map<std::string, square::CameraSightings>;

/// That the solver refused what was captured.
struct RefusedSolution {
  std::optional<std::size_t> corner;  ///< Captured in a wrong place, 0..3; nothing: none is known.
};

/// What one run of the calibration has captured: the live form of samples::Samples (toSamples(),
/// fromSamples()).
struct Captured {
  std::vector<std::string> cameras;            ///< Empty: nothing is started.
  std::optional<square::SquareLayout> layout;  ///< Nothing: a run without a square.
  SquareRun square;
  std::size_t latest_lengths = 0;  ///< The last so many layout->lengths were taken after all else.
  std::vector<capture::CapturedCorner> places;  ///< Of layout->places.
  std::optional<WaveRecorder> wave;             ///< The wave that is being recorded, or was.
  std::string world_frame;
  std::string solved_to;                   ///< The rig's id; empty: not solved yet.
  std::optional<RefusedSolution> refused;  ///< Since then nothing was captured or dropped.
  /// The device that took the data of a camera, and another one that took some, too.
  std::map<std::string, std::string> devices;
  std::map<std::string, std::string> other_devices;
  /// Facts from a samples file; empty: this run is captured live.
  CameraFacts restored_facts;

  /// Notes which device a camera of this run is. @param identity empty: not known.
  void noteDevice(const std::string& camera, const std::string& identity);
  /// Nothing that was captured remains of them.
  void forgetDevices() {
    devices.clear();
    other_devices.clear();
  }

  /// Whether it can be solved: four corners, or without a square a wand.
  bool isComplete() const { return layout ? square.isComplete() : wave && wave->wand(); }
  /// What it lacks for that, or contradicts itself in, and what to do; empty: it can be solved.
  std::string whyNotSolvable() const;

  /// As Calibration::measureLength().
  Reply measureLength(const square::TapedLength& taped, double placement);
  /// Drops the lengths to a corner of the layout, where the LED does not lie any more as it lay.
  void dropLengthsTo(std::size_t corner);

  /// Why no known place can be taken while this rig is in use, and what to do; empty: it can.
  std::string whyNoPlace(const std::optional<geometry::Rig>& rig) const;
  /// Takes where cameras saw the LED on a known place, if whyNoPlace() is empty.
  Reply addPlace(const square::KnownPlace& known, const capture::CapturedCorner& seen);

  /// As Calibration::undo().
  Reply undo();
};

/// A run in which nothing is captured yet. @param layout nothing: a run without a square.
Captured newRun(const std::vector<std::string>& cameras,
                const std::optional<square::SquareLayout>& layout,
                const capture::CornerCaptureOptions& capture,
                const std::string& world_frame);

/// @param live facts of the cameras now; not used for what comes from a samples file.
samples::Samples toSamples(const Captured& captured,
                           const CameraFacts& live,
                           const capture::Masks& masks);

/// The inverse.
Captured fromSamples(const samples::Samples& samples,
                     const capture::CornerCaptureOptions& capture,
                     const wave::CoverageOptions& coverage);

}  // namespace wiimote_tracker::workflow
