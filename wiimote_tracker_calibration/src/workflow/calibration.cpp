#include "wiimote_tracker_calibration/workflow/calibration.h"

#include "wiimote_tracker_calibration/square/error.h"
#include "wiimote_tracker_calibration/wave/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

namespace wiimote_tracker::workflow {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", value);
  return text;
}

}  // namespace

Reply Calibration::start(double side_x, double side_y, const std::vector<std::string>& cameras) {
  square::SquareLayout layout;
  layout.side_x = side_x;
  layout.side_y = side_y;
  layout.led_height = options_.led_height;
  layout.origin = options_.origin;
  layout.yaw = options_.yaw;
  try {
    layout.check();
  } catch (const square::SquareError& error) {
    return refuse(error.what());
  }
  return startWith(cameras, layout);
}

Reply Calibration::startWithoutSquare(const std::vector<std::string>& cameras) {
  return startWith(cameras, std::nullopt);
}

Reply Calibration::startWith(const std::vector<std::string>& cameras,
                             const std::optional<square::SquareLayout>& layout) {
  if (busy_)
    return refuse(occupied());
  const std::set<std::string> different(cameras.begin(), cameras.end());
  if (different.size() < 2)
    return refuse("a calibration needs at least two cameras, but there are " +
                  std::to_string(different.size()) + ": connect the cameras and start again");
  clear();
  cameras_.assign(different.begin(), different.end());
  layout_ = layout;
  world_frame_ = options_.world_frame;
  square_ = SquareRun(cameras_, options_.capture);
  setHandsFree(hands_free_on_);
  step_ = Step::kReady;
  return accept("started with " + std::to_string(cameras_.size()) + " cameras: " +
                (layout_ ? square_.next() : std::string("wave a wand of known length")));
}

Reply Calibration::beginCapture(std::optional<std::size_t> retake, double now) {
  if (busy_)
    return refuse(occupied());
  if (cameras_.empty())
    return refuse("no calibration is started: start one first");
  if (!layout_)
    return refuse("this calibration was started without a square: wave a wand, or start anew");
  const Reply reply = square_.begin(retake, now);
  if (reply.success) {
    busy_ = Step::kCapturing;
    just_solved_ = false;
  }
  return shown(reply);
}

void Calibration::abandonCapture(const std::string& why) {
  square_.abandon(why);
  if (isBusyWith(Step::kCapturing))
    update(0.0);
}

void Calibration::setHandsFree(bool on) {
  hands_free_on_ = on;
  hands_free_.reset();
  if (on && layout_)
    hands_free_.emplace(cameras_, options_.hands_free);
}

Reply Calibration::beginWave(const std::vector<geometry::Camera>& cameras,
                             bool posed,
                             const std::optional<wave::Wand>& wand,
                             double now) {
  if (busy_)
    return refuse(occupied());
  if (cameras_.empty())
    return refuse("no calibration is started: start one first");
  if (wand && !(std::isfinite(wand->length) && wand->length > 0.0 && std::isfinite(wand->stddev) &&
                wand->stddev > 0.0))
    return refuse(
        "the wand's length and its standard deviation must be greater than 0: measure "
        "between the middles of its LEDs, in metres");
  if (!layout_ && !wand)
    return refuse("without a square one LED gives no scale: wave a wand, and give its length");
  try {
    wave_.emplace(cameras, posed, wand, options_.coverage, now);
  } catch (const wave::WaveError& error) {
    return refuse(error.what());
  }
  busy_ = Step::kWaving;
  just_solved_ = false;
  return accept(std::string("recording: wave the ") + (wand ? "wand" : "LED") +
                " through the whole volume, at all heights, without haste");
}

Reply Calibration::endWave() {
  if (!isBusyWith(Step::kWaving))
    return refuse("no wave is being recorded: start one first");
  busy_.reset();
  settle();
  const wave::CoverageReport report = wave_->report();
  std::string message =
      "recorded " + seconds(report.seconds) + " in which two cameras or more saw it move";
  if (!report.enough())
    return accept(message + "; still missing: " + report.missing.front());
  return accept(message + (step_ == Step::kComplete ? ", that is enough: solve"
                                                    : ", that is enough; " + square_.next()));
}

void Calibration::addImage(const capture::Image& image) {
  if (isBusyWith(Step::kWaving))
    wave_->add(image);
  square_.add(image);
  update(image.stamp);
  if (!hands_free_ || busy_ || square_.isComplete())
    return;
  if (hands_free_->add(image, square_.corners())) {
    hands_free_->restart();
    beginCapture(std::nullopt, image.stamp);
  }
}

void Calibration::update(double now) {
  if (!isBusyWith(Step::kCapturing))
    return;
  square_.update(now);
  if (square_.capture())
    return;
  busy_.reset();
  settle();
  shown(*square_.outcome());
}

Reply Calibration::undo() {
  if (busy_)
    return refuse(occupied());
  just_solved_ = false;
  if (wave_) {
    wave_.reset();
    settle();
    return accept("the wave was dropped: record it anew");
  }
  const Reply reply = square_.undo();
  if (reply.success)
    settle();
  return shown(reply);
}

Reply Calibration::cancel() {
  if (busy_ == Step::kCapturing) {
    abandonCapture("it was cancelled");
    return accept(message_);
  }
  if (busy_ == Step::kWaving) {
    busy_.reset();
    wave_.reset();
    settle();
    return accept("the wave was stopped and dropped; the corners stay");
  }
  if (busy_) {
    stopping_ = true;
    return accept("stopping; what was captured before stays");
  }
  if (just_solved_) {
    just_solved_ = false;
    return accept(
        "the solver was done already, and nothing was dropped: cancel once more to drop all that "
        "was captured");
  }
  // The outcome of the last capture stays: whoever waits for it finds it.
  const SquareRun square = square_;
  clear();
  square_ = square;
  square_.restore({});
  step_ = Step::kIdle;
  return accept(rig_ ? "all that was captured was dropped; the rig from before stays in use"
                     : "all that was captured was dropped");
}

Reply Calibration::begin(Step step, const std::string& message) {
  if (busy_)
    return refuse(occupied());
  busy_ = step;
  just_solved_ = false;
  progress_ = 0.0;
  return accept(message);
}

void Calibration::end(const Reply& outcome) {
  just_solved_ = isBusyWith(Step::kSolving);
  busy_.reset();
  stopping_ = false;
  message_ = outcome.message;
}

Reply Calibration::beginSolve() {
  if (busy_)
    return refuse(occupied());
  if (layout_ && !square_.isComplete())
    return refuse("only " + std::to_string(square_.corners().size()) +
                  " of 4 corners are captured: capture the others first");
  if (!layout_ && !hasWand())
    return refuse(cameras_.empty() ? "only 0 of 4 corners are captured: start a calibration first"
                                   : "no wand was waved: record one first");
  return begin(Step::kSolving, "solving");
}

Reply Calibration::finishSolve(const geometry::Rig& rig) {
  Reply reply = {true, rig.verdict};
  geometry::Rig taken = rig;
  if (rig_ && rig_->world_frame == rig.world_frame && !rig_->zones.empty()) {
    taken.zones = rig_->zones;
    reply.message +=
        "; the zones are those of the rig before, and right only if the square lies where it lay";
  }
  end(reply);
  rig_ = taken;
  step_ = Step::kSolved;
  return reply;
}

session::Session Calibration::session(const std::map<std::string, CameraFacts>& live,
                                      const capture::Masks& masks) const {
  const std::map<std::string, CameraFacts>& facts = isRestored() ? restored_facts_ : live;
  session::Session session;
  session.world_frame = world_frame_;
  session.recording.square = layout_;
  if (wave_)
    session.recording.wand = wave_->wand();
  for (const std::string& name : cameras_) {
    wave::CameraRecording camera;
    camera.sightings.name = name;
    const auto fact = facts.find(name);
    if (fact != facts.end()) {
      camera.sightings.identity = fact->second.identity;
      camera.sightings.intrinsics = fact->second.intrinsics;
      camera.sightings.gravity = fact->second.gravity;
    }
    for (std::size_t c = 0; c < square_.corners().size(); ++c) {
      const auto view = square_.corners()[c].find(name);
      if (view != square_.corners()[c].end())
        camera.sightings.corners[c] = view->second.pixel;
    }
    const WaveRecorder::Track* track = wave_ ? wave_->track(name) : nullptr;
    if (track != nullptr) {
      camera.clock_epoch = track->clock_epoch;
      camera.frames = track->frames;
    }
    session.recording.cameras.push_back(camera);
    const auto mask = masks.find(name);
    session.masks.push_back(mask != masks.end() ? mask->second
                                                : std::vector<geometry::ImageMask>());
  }
  return session;
}

Reply Calibration::restore(const session::Session& session) {
  const wave::Recording& recording = session.recording;
  std::vector<std::string> names;
  std::vector<geometry::Camera> cameras;
  std::map<std::string, CameraFacts> facts;
  std::vector<capture::CapturedCorner> corners;
  bool waved = false;
  double first = std::numeric_limits<double>::infinity();
  for (const wave::CameraRecording& camera : recording.cameras) {
    const square::CameraSightings& seen = camera.sightings;
    names.push_back(seen.name);
    facts[seen.name] = {seen.identity, seen.intrinsics, seen.gravity};
    geometry::Camera known;
    known.name = seen.name;
    known.intrinsics = seen.intrinsics;
    cameras.push_back(known);
    for (std::size_t c = 0; c < seen.corners.size(); ++c) {
      if (!seen.corners[c])
        continue;
      corners.resize(std::max(corners.size(), c + 1));
      // How many images it was seen in, and how still it was, is not known any more.
      corners[c][seen.name] = {*seen.corners[c], kNan, 1};
    }
    if (!camera.frames.empty()) {
      waved = true;
      first = std::min(first, camera.frames.front().stamp);
    }
  }
  std::optional<WaveRecorder> wave;
  if (waved) {
    wave.emplace(cameras, false, recording.wand, options_.coverage, first);
    for (const wave::CameraRecording& camera : recording.cameras) {
      for (const wave::Frame& frame : camera.frames)
        wave->add({camera.sightings.name, frame.stamp, camera.clock_epoch, frame.spots, {}});
    }
  }
  const Reply reply = startWith(names, recording.square);
  if (!reply.success)
    return reply;
  cameras_ = names;  // the first is the reference of the others' clocks
  restored_facts_ = facts;
  world_frame_ = session.world_frame;
  square_.restore(corners);
  wave_ = wave;
  settle();
  return accept("samples of " + std::to_string(names.size()) + " cameras with " +
                std::to_string(corners.size()) + " corners" + (waved ? " and a wave" : "") +
                " are loaded: " + (step_ == Step::kComplete ? "solve" : square_.next()));
}

Reply Calibration::load(const geometry::Rig& rig) {
  if (busy_)
    return refuse(occupied());
  rig_ = rig;
  if (cameras_.empty() || step_ == Step::kSolved)
    step_ = Step::kSaved;
  return accept("rig " + rig.id() + " with " + std::to_string(rig.cameras.size()) +
                " cameras is in use");
}

void Calibration::setRig(const geometry::Rig& rig, const std::string& message) {
  rig_ = rig;
  if (cameras_.empty() || step_ == Step::kSaved)
    step_ = Step::kSolved;
  message_ = message;
}

bool Calibration::setMasks(const capture::Masks& masks) {
  if (!rig_)
    return false;
  const std::string id = rig_->id();
  for (geometry::RigCamera& camera : rig_->cameras) {
    const auto found = masks.find(camera.camera.name);
    camera.masks = found != masks.end() ? found->second : std::vector<geometry::ImageMask>();
  }
  if (rig_->remap && rig_->remap->rig_id == id)
    rig_->remap->rig_id = rig_->id();
  return rig_->id() != id;
}

void Calibration::saved(const std::string& message) {
  if (step_ == Step::kSolved)
    step_ = Step::kSaved;
  just_solved_ = false;
  message_ = message;
}

double Calibration::progress() const {
  switch (step()) {
    case Step::kIdle:
      return 0.0;
    case Step::kReady:
      return static_cast<double>(square_.corners().size()) /
             static_cast<double>(SquareRun::kCorners);
    case Step::kCapturing:
      return square_.capture() ? square_.capture()->progress() : 0.0;
    case Step::kWaving:
      return std::min(1.0, wave_->report().seconds / wave_->secondsNeeded());
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
  if (layout_ && !square_.isComplete() && !isBusyWith(Step::kWaving))
    missing.push_back(square_.next());
  if (!cameras_.empty() && !layout_ && !wave_)
    missing.push_back("a wand that is waved, with its length: start the wave");
  if (wave_) {
    const wave::CoverageReport report = wave_->report();
    missing.insert(missing.end(), report.missing.begin(), report.missing.end());
  }
  return missing;
}

std::vector<double> Calibration::sides() const {
  return layout_ ? std::vector<double>{layout_->side_x, layout_->side_y} : std::vector<double>();
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
      return "the place of an LED is being measured: wait until that is over, or cancel";
  }
}

Reply Calibration::refuse(const std::string& message) {
  return shown({false, message});
}

Reply Calibration::accept(const std::string& message) {
  return shown({true, message});
}

Reply Calibration::shown(const Reply& reply) {
  message_ = reply.message;
  return reply;
}

/// Nothing is captured.
void Calibration::clear() {
  cameras_.clear();
  layout_.reset();
  square_ = SquareRun();
  wave_.reset();
  restored_facts_.clear();
  hands_free_.reset();
  just_solved_ = false;
}

/// The step between two requests, by what is captured.
void Calibration::settle() {
  const bool complete = layout_ ? square_.isComplete() : hasWand();
  step_ = complete ? Step::kComplete : Step::kReady;
}

}  // namespace wiimote_tracker::workflow
