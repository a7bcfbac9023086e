#include "camera_status.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker {

namespace {

using wiimote_tracker_msgs::CalibrationCameraStatus;
using wiimote_tracker_msgs::CalibrationStatus;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void addContribution(const workflow::Calibration& calibration, CalibrationCameraStatus* status) {
  for (const capture::CapturedCorner& corner : calibration.square().corners()) {
    const auto view = corner.find(status->name);
    const bool seen = view != corner.end();
    status->samples.push_back(seen ? static_cast<std::uint32_t>(view->second.samples) : 0);
    status->spread.push_back(seen ? view->second.spread : kNan);
    status->corner_x.push_back(seen ? view->second.pixel.x() : kNan);
    status->corner_y.push_back(seen ? view->second.pixel.y() : kNan);
  }
  const auto& capture = calibration.square().capture();
  if (!capture)
    return;
  const std::vector<std::string>& names = calibration.cameras();
  if (std::find(names.begin(), names.end(), status->name) == names.end())
    return;
  const capture::StillSpot& spot = capture->spot(status->name);
  const auto samples = static_cast<std::uint32_t>(spot.samples());
  // A corner that is taken again stands in its old place, a new one at the end.
  const std::size_t corner = calibration.square().currentCorner();
  status->samples.resize(std::max(status->samples.size(), corner + 1));
  status->spread.resize(std::max(status->spread.size(), corner + 1));
  status->samples[corner] = samples;
  status->spread[corner] = spot.spread();
  status->problem = capture->problem(status->name);
}

void addWave(const std::vector<wave::CameraCoverage>& waved, CalibrationCameraStatus* status) {
  const auto found =
      std::find_if(waved.begin(), waved.end(),
                   [&](const wave::CameraCoverage& camera) { return camera.name == status->name; });
  if (found == waved.end())
    return;
  status->image_coverage = found->image_share;
  status->speed = found->image_speed;
  status->wave_seconds = found->together;
  for (std::size_t cell = 0; cell < found->filled.size(); ++cell)
    status->image_cells.push_back(found->filled[cell]);
}

/// Whether a camera may see so many spots: any while lamps are learned, both LEDs of a wand.
bool isRight(std::size_t spots, const workflow::Calibration& calibration) {
  const bool squareless = !calibration.cameras().empty() && calibration.sides().empty();
  const bool has_wand = squareless || (calibration.wave() && calibration.wave()->wand());
  return calibration.step() == workflow::Step::kMasking || (has_wand && (spots == 1 || spots == 2));
}

}  // namespace

std::vector<CalibrationCameraStatus> cameraStatus(const workflow::Calibration& calibration,
                                                  const std::map<std::string, CameraInput>& cameras,
                                                  double now,
                                                  double window) {
  std::vector<wave::CameraCoverage> waved;
  if (calibration.wave())
    waved = calibration.wave()->report().cameras;
  std::vector<CalibrationCameraStatus> result;
  for (const auto& entry : cameras) {
    const capture::CameraSummary summary = entry.second.monitor.summary(now, window);
    CalibrationCameraStatus status;
    status.name = entry.first;
    status.identity = entry.second.identity;
    status.connected = summary.connected;
    status.rate = summary.rate;
    status.blobs = static_cast<std::uint32_t>(summary.blobs);
    status.sees_led = summary.sees_led;
    status.x = summary.pixel.x();
    status.y = summary.pixel.y();
    status.image_coverage = kNan;
    status.speed = kNan;
    status.wave_seconds = kNan;
    if (!summary.connected || !isRight(summary.blobs, calibration))
      status.problem = summary.problem;
    addContribution(calibration, &status);
    addWave(waved, &status);
    result.push_back(status);
  }
  return result;
}

CalibrationStatus calibrationStatus(const workflow::Calibration& calibration,
                                    const samples::Verdict& verdict) {
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
  const workflow::NextStep next = workflow::nextStep(calibration, verdict);
  status.next_title = next.title;
  status.next_sentence = next.sentence;
  status.next_request = next.request;
  status.next_label = next.label;
  status.next_corner = next.corner ? static_cast<std::int32_t>(*next.corner) : -1;
  status.progress = calibration.progress();
  status.corners_captured = static_cast<std::uint32_t>(calibration.square().corners().size());
  status.square_sides = calibration.sides();
  const bool squareless = !calibration.cameras().empty() && status.square_sides.empty();
  status.corners_needed = squareless ? 0 : workflow::SquareRun::kCorners;
  status.missing = calibration.missing();
  status.hands_free = calibration.isHandsFree();
  if (calibration.wave()) {
    status.wave_seconds = calibration.wave()->report().seconds;
    if (calibration.wave()->wand())
      status.wand_length = calibration.wave()->wand()->length;
  }
  if (calibration.rig())
    status.rig_id = calibration.rig()->id();
  return status;
}

}  // namespace wiimote_tracker
