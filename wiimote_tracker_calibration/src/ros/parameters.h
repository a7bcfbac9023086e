#pragma once

#include "capture/mask_learner.h"
#include "health/health_watch.h"
#include "recalibrate/recalibrate_camera.h"
#include "samples/solve_samples.h"
#include "wiimote_tracker_calibration/intrinsics/board.h"
#include "workflow/calibration.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Which proposals of continuous calibration are applied without being asked.
enum class ContinuousPolicy {
  kOff,      ///< There are no proposals.
  kPropose,  ///< None.
  kKnocked,  ///< A camera that was knocked.
  kAll,      ///< A camera that drifted, too.
};

/// Parameters of the calibration node; config/calibration.yaml describes each.
struct Parameters {
  std::vector<std::string> cameras;  ///< Empty: discover them.
  double side_length = 0.0;          ///< First to second corner [m]; 0: not given.
  double second_side_length = 0.0;   ///< Second to third corner [m]; 0: the same.
  std::string rig_file;
  std::string file_folder;               ///< Of files that requests name; empty: that of rig_file.
  double set_camera_info_timeout = 3.0;  ///< [s]
  bool hands_free = false;
  bool sounds = true;         ///< Publish calibration/sound.
  std::string button_remote;  ///< Namespace of a spare remote; empty: none.
  capture::MaskOptions masks;
  workflow::CalibrationOptions calibration;
  samples::SolveOptions solve;
  health::HealthOptions health;
  ContinuousPolicy continuous_policy = ContinuousPolicy::kPropose;
  intrinsics::Board board;          ///< The 16-LED board.
  int board_views = 12;             ///< Least number to solve a lens.
  geometry::Intrinsics intrinsics;  ///< Of all cameras but those in own_intrinsics.
  std::map<std::string, geometry::Intrinsics> own_intrinsics;  ///< by name.

  /// Starting intrinsics of a camera.
  const geometry::Intrinsics& intrinsicsOf(const std::string& camera) const;

  /// How one camera is solved against the others: as in a wave of all.
  recalibrate::Options recalibrateOptions() const;
};

/// Of a node, or of a file like config/calibration.yaml.
/// @throws ParameterError naming the key that is unknown, of the wrong type or out of range.
Parameters readParameters(ParameterReader* reader);
inline Parameters readParameters(ParameterReader reader) {
  return readParameters(&reader);
}

}  // namespace wiimote_tracker
