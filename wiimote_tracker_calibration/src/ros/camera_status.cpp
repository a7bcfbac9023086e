#include "camera_status.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker {

namespace {

using wiimote_tracker_msgs::CalibrationCameraStatus;
using wiimote_tracker_msgs::CalibrationStatus;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void addContribution(const workflow::Calibration& calibration, CalibrationCameraStatus* status) {
  for (const capture::CapturedCorner& corner : calibration.corners()) {
    const auto view = corner.find(status->name);
    const bool seen = view != corner.end();
    status->samples.push_back(seen ? static_cast<std::uint32_t>(view->second.samples) : 0);
    status->spread.push_back(seen ? view->second.spread : kNan);
  }
  const auto& capture = calibration.currentCapture();
  if (!capture)
    return;
  const std::vector<std::string>& names = calibration.cameras();
  if (std::find(names.begin(), names.end(), status->name) == names.end())
    return;
  const capture::StillSpot& spot = capture->spot(status->name);
  const auto samples = static_cast<std::uint32_t>(spot.samples());
  // A corner that is taken again stands in its old place, a new one at the end.
  const std::size_t corner = calibration.currentCorner();
  status->samples.resize(std::max(status->samples.size(), corner + 1));
  status->spread.resize(std::max(status->spread.size(), corner + 1));
  status->samples[corner] = samples;
  status->spread[corner] = spot.spread();
  status->problem = capture->problem(status->name);
}

}  // namespace

std::vector<CalibrationCameraStatus> cameraStatus(const workflow::Calibration& calibration,
                                                  const std::map<std::string, CameraInput>& cameras,
                                                  double now,
                                                  double window) {
  std::vector<CalibrationCameraStatus> result;
  for (const auto& entry : cameras) {
    const capture::CameraView view = entry.second.monitor.view(now, window);
    CalibrationCameraStatus status;
    status.name = entry.first;
    status.identity = entry.second.identity;
    status.connected = view.connected;
    status.rate = view.rate;
    status.blobs = static_cast<std::uint32_t>(view.blobs);
    status.sees_led = view.sees_led;
    status.x = view.pixel.x();
    status.y = view.pixel.y();
    status.image_coverage = kNan;
    status.speed = kNan;
    status.problem = view.problem;
    addContribution(calibration, &status);
    result.push_back(status);
  }
  return result;
}

CalibrationStatus calibrationStatus(const workflow::Calibration& calibration) {
  static_assert(static_cast<int>(workflow::Step::kIdle) == CalibrationStatus::IDLE &&
                    static_cast<int>(workflow::Step::kReady) == CalibrationStatus::READY &&
                    static_cast<int>(workflow::Step::kCapturing) == CalibrationStatus::CAPTURING &&
                    static_cast<int>(workflow::Step::kWaving) == CalibrationStatus::WAVING &&
                    static_cast<int>(workflow::Step::kComplete) == CalibrationStatus::COMPLETE &&
                    static_cast<int>(workflow::Step::kSolving) == CalibrationStatus::SOLVING &&
                    static_cast<int>(workflow::Step::kSolved) == CalibrationStatus::SOLVED &&
                    static_cast<int>(workflow::Step::kSaved) == CalibrationStatus::SAVED &&
                    static_cast<int>(workflow::Step::kMasking) == CalibrationStatus::MASKING &&
                    static_cast<int>(workflow::Step::kMeasuring) == CalibrationStatus::MEASURING,
                "the steps of the core and of the message must agree");
  CalibrationStatus status;
  status.step = static_cast<std::uint8_t>(calibration.step());
  status.message = calibration.message();
  status.progress = calibration.progress();
  status.corners_captured = static_cast<std::uint32_t>(calibration.corners().size());
  status.corners_needed = workflow::Calibration::kCorners;
  status.square_sides = calibration.sides();
  if (calibration.rig())
    status.rig_id = calibration.rig()->id();
  return status;
}

}  // namespace wiimote_tracker
