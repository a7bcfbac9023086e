#include "workflow/calibration.h"

#include "square/error.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <utility>

namespace wiimote_tracker::workflow {
namespace {

constexpr double kLongestSide = 20.0;  // of a square that Wii Remotes see [m]

}  // namespace

Reply Calibration::start(double side_x, double side_y, const std::vector<std::string>& cameras) {
  square::SquareLayout layout = options_.layout;
  layout.side_x = side_x;
  layout.side_y = side_y;
  try {
    layout.check();
  } catch (const square::SquareError& error) {
    return refusal(error.what());
  }
  if (std::max(side_x, side_y) > kLongestSide)
    return refusal(format("a square of %g m x %g m is larger than %g m: give its sides in metres",
                          side_x, side_y, kLongestSide));
  return startWith(newRun(cameras, layout, options_.capture, options_.world_frame));
}

Reply Calibration::startWithoutSquare(const std::vector<std::string>& cameras) {
  return startWith(newRun(cameras, std::nullopt, options_.capture, options_.world_frame));
}

Reply Calibration::startWith(Captured captured) {
  if (busy_)
    return refusal(occupied());
  const std::size_t count = captured.cameras.size();
  if (count < 2)
    return refusal("a calibration needs at least two cameras, but there is " +
                   (count == 0
                        ? "none: connect the cameras and start again"
                        : "only " + captured.cameras[0] +
                              ": connect another one, and name at least two, or none for all"));
  if (const std::string clash = geometry::nameClash(captured.cameras); !clash.empty())
    return refusal(clash);
  captured_ = std::move(captured);
  just_solved_ = false;
  setHandsFree(hands_free_on_);
  step_ = Step::kReady;
  const std::string started = "started with " + std::to_string(count) + " cameras";
  if (!captured_.layout)
    return {true, started + ": wave a wand of known length"};
  return {true, started +
                    format(" and a square of %g m x %g m: ", captured_.layout->side_x,
                           captured_.layout->side_y) +
                    captured_.square.next()};
}

Reply Calibration::beginCapture(std::optional<std::size_t> retake, double now) {
  if (busy_)
    return refusal(occupied());
  if (captured_.cameras.empty())
    return refusal("no calibration is started: start one first");
  if (!captured_.layout)
    return refusal("this calibration was started without a square: wave a wand, or start again");
  const Reply reply = captured_.square.begin(retake, now);
  if (reply.success) {
    if (captured_.square.corners().empty() && !captured_.wave)
      captured_.forgetDevices();
    busy_ = Step::kCapturing;
    just_solved_ = false;
  }
  return reply;
}

void Calibration::abandonCapture(const std::string& why) {
  captured_.square.abandon(why);
  finishCapture();
}

void Calibration::setHandsFree(bool on) {
  hands_free_on_ = on;
  hands_free_.reset();
  if (on && captured_.layout)
    hands_free_.emplace(captured_.cameras, options_.hands_free);
}

Reply Calibration::beginWave(const std::vector<geometry::Camera>& cameras,
                             bool posed,
                             const std::optional<wave::Wand>& wand,
                             double now) {
  if (busy_)
    return refusal(occupied());
  if (captured_.cameras.empty())
    return refusal("no calibration is started: start one first");
  if (!captured_.layout && !wand)
    return refusal("without a square one LED gives no scale: wave a wand, and give its length");
  try {
    if (wand)
      wand->check();
  } catch (const wave::WaveError& error) {
    return refusal(error.what());
  }
  if (captured_.wave)
    captured_.refused.reset();  // it is dropped
  if (captured_.square.corners().empty())
    captured_.forgetDevices();
  captured_.wave.emplace(cameras, posed, wand, options_.coverage, now);
  busy_ = Step::kWaving;
  just_solved_ = false;
  if (captured_.wave->needsFloor())
    return {true, "recording: leave the wand on the floor"};
  return {true, std::string("recording: wave the ") + (wand ? "wand" : "LED") +
                    " through the whole volume, at all heights, at 0.5 m/s or faster"};
}

Reply Calibration::endWave() {
  if (!isBusyWith(Step::kWaving))
    return refusal("no wave is being recorded: start one first");
  busy_.reset();
  captured_.latest_lengths = 0;
  captured_.refused.reset();
  updateStep();
  const wave::CoverageReport report = captured_.wave->report();
  std::string message =
      format("recorded %.1f s", report.seconds) + " in which two cameras or more saw it move";
  if (!report.enough())
    return {true, message + "; still missing: " + report.missing.front()};
  return {true,
          message + (step_ == Step::kComplete ? ", that is enough: solve"
                                              : ", that is enough; " + captured_.square.next())};
}

void Calibration::abandonWave(const std::string& why) {
  if (isBusyWith(Step::kWaving))
    shown(refusal("the wave was ended: " + why + "; " + endWave().message));
}

void Calibration::addImage(const capture::Image& image) {
  if (isBusyWith(Step::kWaving) || isBusyWith(Step::kCapturing))
    captured_.noteDevice(image.camera, image.identity);
  if (isBusyWith(Step::kWaving) && captured_.wave->add(image)) {
    ++captures_;
    shown(
        {true, "the wand on the floor is captured: lift it, and wave it through the whole volume"});
  }
  captured_.square.add(image);
  finishCapture();
  if (!hands_free_ || busy_ || captured_.square.isComplete())
    return;
  if (hands_free_->add(image, captured_.square.corners())) {
    hands_free_->restart();
    shown(beginCapture(std::nullopt, image.stamp));
  }
}

void Calibration::update(double now) {
  captured_.square.update(now);
  finishCapture();
}

void Calibration::finishCapture() {
  if (!isBusyWith(Step::kCapturing) || captured_.square.capture())
    return;
  busy_.reset();
  if (captured_.square.outcome()->success) {
    updateStep();
    captured_.dropLengthsTo(captured_.square.currentCorner());
    captured_.latest_lengths = 0;
    captured_.refused.reset();
    ++captures_;
  }
  shown(*captured_.square.outcome());
}

Reply Calibration::measureLength(const square::TapedLength& taped, double placement) {
  if (busy_)
    return refusal(occupied());
  just_solved_ = false;
  return changed(captured_.measureLength(taped, placement));
}

Reply Calibration::addPlace(const square::KnownPlace& known, const capture::CapturedCorner& seen) {
  if (const std::string reason = whyNoPlace(); !reason.empty())
    return refusal(reason);
  return changed(captured_.addPlace(known, seen));
}

Reply Calibration::undo() {
  if (busy_)
    return refusal(occupied());
  just_solved_ = false;
  return changed(captured_.undo());
}

Reply Calibration::cancel() {
  if (busy_ == Step::kCapturing) {
    abandonCapture("it was cancelled");
    return {true, message_};
  }
  if (busy_ == Step::kWaving) {
    busy_.reset();
    captured_.wave.reset();
    updateStep();
    return {true, std::string("the wave was stopped and dropped") +
                      (captured_.square.corners().empty() ? "" : "; the corners stay")};
  }
  if (busy_) {
    stopping_ = true;
    return {true, "stopping; what was captured before stays"};
  }
  if (just_solved_) {
    just_solved_ = false;
    return {
        true,
        "the solver had already finished, and nothing was dropped: cancel again to drop all that "
        "was captured"};
  }
  // The outcome of the last capture stays: the action may still wait for it.
  SquareRun square = captured_.square;
  square.restore({});
  captured_ = Captured();
  captured_.square = square;
  hands_free_.reset();
  step_ = Step::kIdle;
  return {true, rig_ ? "all that was captured was dropped; the rig from before stays in use"
                     : "all that was captured was dropped"};
}

Reply Calibration::begin(Step step, const std::string& message, bool is_waved) {
  const bool ends_wave =
      step == Step::kSolving && isBusyWith(Step::kWaving) && captured_.wave->report().enough();
  if (busy_ && !ends_wave)
    return refusal(occupied());
  if (const std::string reason = captured_.whyNotSolvable();
      step == Step::kSolving && !reason.empty())
    return refusal(reason);
  if (ends_wave)
    endWave();
  busy_ = step;
  is_waved_ = is_waved;
  just_solved_ = false;
  progress_ = 0.0;
  return {true, message};
}

void Calibration::end() {
  just_solved_ = busy_ == Step::kSolving;
  busy_.reset();
  stopping_ = false;
}

Reply Calibration::takeSolution(const geometry::Rig& rig) {
  Reply reply = {true, rig.verdict};
  const std::optional<geometry::Rig> before = rig_;
  use(rig);
  if (before && before->world_frame == rig.world_frame && !before->zones.empty()) {
    rig_->zones = before->zones;
    reply.message +=
        "; the zones of the rig before are kept, and are right only if the square lies where it "
        "lay";
  }
  captured_.solved_to = rig_->id();
  captured_.refused.reset();
  step_ = Step::kSolved;
  return reply;
}

Reply Calibration::restore(const samples::Samples& samples) {
  const Reply reply = startWith(fromSamples(samples, options_.capture, options_.coverage));
  if (!reply.success)
    return reply;
  updateStep();
  for (const wave::CameraRecording& camera : samples.recording.cameras)
    preparation_.lights_learned |= !camera.masks.empty();
  return {true, "samples of " + counted(captured_.cameras.size(), "camera") + " with " +
                    counted(captured_.square.corners().size(), "corner") +
                    (captured_.wave ? " and a wave" : "") + " are loaded: " +
                    (step_ == Step::kComplete ? "solve" : captured_.square.next())};
}

Reply Calibration::load(const geometry::Rig& rig) {
  if (busy_)
    return refusal(occupied());
  use(rig);
  in_file_ = rig;
  for (const geometry::RigCamera& camera : rig.cameras)
    preparation_.lights_learned |= !camera.masks.empty();
  if (captured_.cameras.empty() || step_ == Step::kSolved)
    step_ = Step::kSaved;
  const std::string far_camera = rig.describeFarCamera();
  return {true, "rig " + rig.id() + " with " + counted(rig.cameras.size(), "camera") +
                    " is in use" + (far_camera.empty() ? "" : "; but " + far_camera)};
}

void Calibration::setRig(const geometry::Rig& rig, const std::string& message) {
  use(rig);
  if (captured_.cameras.empty() || step_ == Step::kSolved || step_ == Step::kSaved)
    step_ = stepOfRig();
  message_ = message;
}

void Calibration::use(const geometry::Rig& rig) {
  rig_ = rig;
  goal_.reset();
}

Step Calibration::stepOfRig() const {
  // A correction of the volume does not change the id.
  const bool is_in_file =
      in_file_ && in_file_->id() == rig_->id() && in_file_->remap == rig_->remap;
  return is_in_file ? Step::kSaved : Step::kSolved;
}

bool Calibration::setMasks(const capture::Masks& masks) {
  if (!rig_)
    return false;
  const std::string id = rig_->id();
  rig_ = capture::withMasks(*rig_, masks);
  if (goal_)
    goal_ = capture::withMasks(*goal_, masks);
  if (captured_.solved_to == id)
    captured_.solved_to = rig_->id();
  if (step_ == Step::kSolved || step_ == Step::kSaved)
    step_ = stepOfRig();
  return rig_->id() != id;
}

void Calibration::saved(const geometry::Rig& rig) {
  in_file_ = rig;
  if (step_ == Step::kSolved)
    step_ = stepOfRig();
  just_solved_ = false;
}

double Calibration::progress() const {
  switch (step()) {
    case Step::kIdle:
      return 0.0;
    case Step::kReady:
      return static_cast<double>(captured_.square.corners().size()) / SquareRun::kCorners;
    case Step::kCapturing:
      return captured_.square.capture() ? captured_.square.capture()->progress() : 0.0;
    case Step::kWaving:
      return std::min(1.0, captured_.wave->report().seconds / captured_.wave->secondsNeeded());
    case Step::kComplete:
    case Step::kSolved:
    case Step::kSaved:
      return 1.0;
    default:
      return progress_;
  }
}

std::vector<std::string> Calibration::missing() const {
  std::vector<std::string> missing;
  if (captured_.layout && !captured_.square.isComplete() && !isBusyWith(Step::kWaving))
    missing.push_back(captured_.square.next());
  if (!captured_.cameras.empty() && !captured_.layout && !captured_.wave)
    missing.push_back("a wand that is waved, with its length: start the wave");
  if (captured_.wave) {
    const wave::CoverageReport report = captured_.wave->report();
    missing.insert(missing.end(), report.missing.begin(), report.missing.end());
  }
  return missing;
}

std::string Calibration::occupied() const {
  if (stopping_)
    return "what was cancelled has not stopped yet: try again in a moment";
  switch (*busy_) {
    case Step::kCapturing:
      return "a corner is being captured: wait until that is over, or cancel";
    case Step::kWaving:
      return "a wave is being recorded: stop it first";
    case Step::kSolving:
      return "the solver runs: wait until it is done, or cancel";
    case Step::kMasking:
      return "other lights are being learned: wait until that is over, or cancel";
    default:
      return "a place or a camera is being measured: wait until that is over, or cancel";
  }
}

Reply Calibration::changed(const Reply& reply) {
  if (reply.success) {
    captured_.refused.reset();
    updateStep();
  }
  return reply;
}

Reply Calibration::shown(const Reply& reply) {
  message_ = reply.message;
  refusals_ += reply.success ? 0 : 1;
  return reply;
}

}  // namespace wiimote_tracker::workflow
