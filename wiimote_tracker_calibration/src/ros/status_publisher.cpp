#include "status_publisher.h"

#include "health/remedy.h"
#include "square_frame.h"

#include <std_msgs/String.h>
#include <wiimote_tracker_msgs/CalibrationStatus.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

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

bool isWithoutSquare(const workflow::Calibration& calibration) {
  return !calibration.cameras().empty() && !calibration.layout();
}

/// Whether a camera may see so many spots: any while lamps are learned, both LEDs of a wand.
bool isRight(std::size_t spots, const workflow::Calibration& calibration) {
  const bool has_wand =
      isWithoutSquare(calibration) || (calibration.wave() && calibration.wave()->wand());
  return calibration.step() == workflow::Step::kMasking || (has_wand && (spots == 1 || spots == 2));
}

/// Where the calibration stands, without header and cameras. @param verdict of the rig in use.
CalibrationStatus calibrationStatus(const workflow::Calibration& calibration,
                                    const samples::Verdict& verdict,
                                    const workflow::Findings& findings) {
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
  const workflow::NextStep next = workflow::nextStep(calibration, verdict, findings);
  status.next_title = next.title;
  status.next_sentence = next.sentence;
  status.next_request = next.request;
  status.next_label = next.label;
  status.next_corner = next.corner ? static_cast<std::int32_t>(*next.corner) : -1;
  status.progress = calibration.progress();
  status.corners_captured = static_cast<std::uint32_t>(calibration.square().corners().size());
  if (const auto& square = calibration.layout())
    status.square_sides = {square->side_x, square->side_y};
  status.corners_needed = isWithoutSquare(calibration) ? 0 : workflow::SquareRun::kCorners;
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

}  // namespace

StatusPublisher::StatusPublisher(const Parameters& parameters,
                                 const workflow::Calibration& calibration,
                                 ros::NodeHandle* nh,
                                 CameraInputs* inputs,
                                 tf2_ros::StaticTransformBroadcaster* transforms)
    : parameters_(parameters),
      calibration_(calibration),
      inputs_(*inputs),
      transforms_(*transforms),
      status_publisher_(nh->advertise<CalibrationStatus>("calibration/status", 1, true)),
      square_publisher_(
          nh->advertise<geometry_msgs::PolygonStamped>("calibration/square", 1, true)),
      sound_publisher_(nh->advertise<std_msgs::String>("calibration/sound", 10)) {
  // Before a calibration, too, so that the world is a frame that others can show.
  transforms_.sendTransform(
      squareTransform(parameters.calibration.world_frame, parameters.calibration.layout));
  inputs->subscribeImages([this](const capture::Image& image, const Lock&) {
    const CameraInput& camera = inputs_.cameras().at(image.camera);
    if (isWalked() && camera.width > 0 && camera.height > 0)
      walk_.add(image, camera.width, camera.height);
  });
}

void StatusPublisher::beginWalk() {
  walk_.restart();
  walk_is_wanted_ = true;
}

bool StatusPublisher::isWalked() const {
  return calibration_.cameras().empty() && (!calibration_.rig() || walk_is_wanted_);
}

std::string StatusPublisher::health(const std::string& camera) const {
  const auto found = health_.find(camera);
  const health::CameraHealth health =
      found == health_.end() ? health::CameraHealth() : found->second;
  if (std::count(correctable_.begin(), correctable_.end(), camera) == 0) {
    // What is proposed says which cameras were moved; against these others seem to be off, too.
    const bool is_explained =
        health.by_images && !correctable_.empty() && cause_ == continuous::Cause::kKnock;
    return health.text.empty() || is_explained ? "" : health.text + "; " + health.advice;
  }
  const std::string before = health.text.empty() ? "" : health.text + "; ";
  if (camera != correctable_.front())
    return before + "what is proposed for " + correctable_.front() + " corrects it, too";
  const bool names_it = proposal_text_.rfind(camera + " ", 0) == 0;
  if (!names_it)
    return before + proposal_text_;
  return before + (before.empty() ? "" : "it ") + proposal_text_.substr(camera.size() + 1);
}

workflow::Findings StatusPublisher::findings() const {
  workflow::Findings findings;
  for (const auto& [name, health] : health_) {
    if (health.text.empty())
      continue;
    const bool is_same = findings.changed.empty() || findings.remedy == health.advice;
    findings.changed.push_back(name);
    findings.remedy = is_same ? health.advice : health::putBack(*calibration_.rig(), false);
  }
  findings.correctable = correctable_;
  findings.cause = cause_;
  if (calibration_.rig())
    findings.silent = inputs_.describeSilent(*calibration_.rig());
  return findings;
}

std::vector<CalibrationCameraStatus> StatusPublisher::cameras(double window) const {
  std::vector<wave::CameraCoverage> waved;
  if (calibration_.wave())
    waved = calibration_.wave()->report().cameras;
  const double now = ros::Time::now().toSec();
  std::vector<CalibrationCameraStatus> result;
  for (const auto& [name, input] : inputs_.cameras()) {
    const capture::CameraSummary summary = input.monitor.summary(now, window);
    CalibrationCameraStatus status;
    status.name = name;
    status.identity = input.identity;
    status.connected = summary.connected;
    status.rate = summary.rate;
    status.blobs = static_cast<std::uint32_t>(summary.blobs);
    status.sees_led = summary.sees_led;
    status.x = summary.pixel.x();
    status.y = summary.pixel.y();
    status.image_coverage = kNan;
    status.speed = kNan;
    status.wave_seconds = kNan;
    if (!summary.connected || !isRight(summary.blobs, calibration_))
      status.problem = summary.problem;
    addContribution(calibration_, &status);
    addWave(waved, &status);
    if (const auto masks = inputs_.masks().find(name); masks != inputs_.masks().end())
      status.masks = static_cast<std::uint32_t>(masks->second.size());
    status.health = health(name);
    status.seen_share = walk_.share(name);
    status.seen_with = walk_.seenWith(name);
    result.push_back(status);
  }
  return result;
}

void StatusPublisher::publish(const samples::Verdict& verdict) {
  CalibrationStatus status = calibrationStatus(calibration_, verdict, findings());
  status.header.stamp = ros::Time::now();
  status.header.frame_id = parameters_.calibration.world_frame;
  status.cameras = cameras(1.0);
  if (isWalked())
    status.walk = walk_.sentence();
  status_publisher_.publish(status);
  publishSquare();
  publishSound();
}

void StatusPublisher::publishSound() {
  std_msgs::String sound;
  sound.data = sounds_.heard(calibration_);
  if (parameters_.sounds && !sound.data.empty())
    sound_publisher_.publish(sound);
}

void StatusPublisher::publishSquare() {
  std::optional<square::SquareLayout> square = calibration_.layout();
  std::string world_frame = parameters_.calibration.world_frame;
  if (!square && calibration_.rig()) {
    square = squareOf(*calibration_.rig());
    world_frame = calibration_.rig()->world_frame;
  }
  const geometry_msgs::PolygonStamped outline = squareOutline(world_frame, square);
  if (outline == outline_)
    return;
  outline_ = outline;
  square_publisher_.publish(outline);
  if (square)
    transforms_.sendTransform(squareTransform(world_frame, *square));
}

}  // namespace wiimote_tracker
