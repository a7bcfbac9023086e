#include "wiimote_tracker_calibration/workflow/calibration.h"

#include "wiimote_tracker_calibration/square/error.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace wiimote_tracker::workflow {

namespace {

// An LED that was not carried on appears within this distance of where it was [px].
constexpr double kSamePlace = 3.0;

std::string cornerName(std::size_t corner) {
  return "corner " + std::to_string(corner + 1);
}

square::SquareLayout layoutOf(const CalibrationOptions& options, double side_x, double side_y) {
  square::SquareLayout layout;
  layout.side_x = side_x;
  layout.side_y = side_y;
  layout.led_height = options.led_height;
  layout.origin = options.origin;
  layout.yaw = options.yaw;
  return layout;
}

}  // namespace

Reply Calibration::start(double side_x, double side_y, const std::vector<std::string>& cameras) {
  if (busy_)
    return refuse(occupied());
  try {
    layoutOf(options_, side_x, side_y).check();
  } catch (const square::SquareError& error) {
    return refuse(error.what());
  }
  const std::set<std::string> different(cameras.begin(), cameras.end());
  if (different.size() < 2)
    return refuse("a calibration needs at least two cameras, but there are " +
                  std::to_string(different.size()) + ": connect the cameras and start again");
  cameras_.assign(different.begin(), different.end());
  sides_ = {side_x, side_y};
  corners_.clear();
  step_ = Step::kReady;
  return accept("started with " + std::to_string(cameras_.size()) +
                " cameras: put the LED on corner 1 and capture it");
}

Reply Calibration::beginCapture(std::optional<std::size_t> retake, double now) {
  if (busy_)
    return refuse(occupied());
  if (sides_.empty())
    return refuse("no calibration is started: start one first");
  if (retake && *retake >= corners_.size())
    return refuse(cornerName(*retake) + " cannot be taken again, " +
                  std::to_string(corners_.size()) +
                  " are captured so far: take the next corner, or retake one of those");
  if (!retake && corners_.size() == kCorners)
    return refuse("all four corners are captured: solve, or retake one of them");
  current_corner_ = retake.value_or(corners_.size());
  capture_.emplace(cameras_, options_.capture, now);
  capture_outcome_.reset();
  busy_ = Step::kCapturing;
  return accept("capturing " + cornerName(current_corner_) + ": keep the LED still");
}

void Calibration::addImage(const capture::Image& image) {
  if (!capture_)
    return;
  capture_->add(image.camera, image.stamp, image.spots);
  finishCapture();
}

void Calibration::update(double now) {
  if (!capture_)
    return;
  capture_->update(now);
  finishCapture();
}

void Calibration::finishCapture() {
  const capture::CornerCapture::State state = capture_->state();
  if (state == capture::CornerCapture::State::kCollecting)
    return;
  const std::string name = cornerName(current_corner_);
  if (state == capture::CornerCapture::State::kRefused)
    return endCapture({false, name + " was not captured: " + capture_->message()});
  const capture::CapturedCorner corner = capture_->result();
  if (const auto other = cornerInSamePlace(corner))
    return endCapture({false, name + " was not captured: the LED is still where " +
                                  cornerName(*other) +
                                  " was captured; carry it on and capture again"});
  if (current_corner_ < corners_.size())
    corners_[current_corner_] = corner;
  else
    corners_.push_back(corner);
  const std::string next =
      corners_.size() == kCorners
          ? "; all four corners are there: solve"
          : "; put the LED on " + cornerName(corners_.size()) + " and capture it";
  endCapture({true, name + " " + capture_->message() + next});
}

void Calibration::endCapture(const Reply& outcome) {
  capture_.reset();
  capture_outcome_ = outcome;
  busy_.reset();
  settle();
  message_ = outcome.message;
}

void Calibration::abandonCapture(const std::string& why) {
  if (capture_)
    endCapture({false, cornerName(current_corner_) + " was not captured: " + why});
}

Reply Calibration::undo() {
  if (busy_)
    return refuse(occupied());
  if (corners_.empty())
    return refuse("there is no captured corner to undo");
  corners_.pop_back();
  settle();
  return accept(cornerName(corners_.size()) + " was dropped: put the LED there and capture it");
}

Reply Calibration::cancel() {
  if (busy_ && *busy_ != Step::kCapturing) {
    busy_.reset();
    return accept("stopped; what was captured before stays");
  }
  abandonCapture("it was cancelled");
  corners_.clear();
  cameras_.clear();
  sides_.clear();
  step_ = Step::kIdle;
  return accept(rig_ ? "cancelled; the rig from before stays in use" : "cancelled");
}

Reply Calibration::begin(Step step, const std::string& message) {
  if (busy_)
    return refuse(occupied());
  busy_ = step;
  progress_ = 0.0;
  return accept(message);
}

void Calibration::end(const Reply& outcome) {
  if (!busy_)
    return;
  busy_.reset();
  message_ = outcome.message;
}

Reply Calibration::beginSolve() {
  if (busy_)
    return refuse(occupied());
  if (corners_.size() < kCorners)
    return refuse("only " + std::to_string(corners_.size()) +
                  " of 4 corners are captured: capture the others first");
  busy_ = Step::kSolving;
  progress_ = 0.0;
  return accept("solving");
}

Reply Calibration::solve(const std::map<std::string, CameraFacts>& facts, double time) {
  if (!isBusyWith(Step::kSolving)) {
    const Reply ready = beginSolve();
    if (!ready.success)
      return ready;
  }
  std::vector<square::CameraSightings> sightings;
  for (const std::string& name : cameras_) {
    square::CameraSightings camera;
    camera.name = name;
    const auto fact = facts.find(name);
    if (fact != facts.end()) {
      camera.identity = fact->second.identity;
      camera.intrinsics = fact->second.intrinsics;
      camera.gravity = fact->second.gravity;
    }
    for (std::size_t c = 0; c < kCorners; ++c) {
      const auto view = corners_[c].find(name);
      if (view != corners_[c].end())
        camera.corners[c] = view->second.pixel;
    }
    sightings.push_back(camera);
  }
  try {
    square::SquareSolution solution =
        square::solveSquare(layoutOf(options_, sides_[0], sides_[1]), sightings, options_.solve);
    solution.rig.world_frame = options_.world_frame;
    solution.rig.solved_at = time;
    solution.rig.check();
    rig_ = solution.rig;
  } catch (const geometry::Error& error) {
    busy_.reset();
    return refuse(error.what());
  }
  busy_.reset();
  step_ = Step::kSolved;
  return accept(rig_->verdict);
}

Reply Calibration::load(const geometry::Rig& rig) {
  if (busy_)
    return refuse(occupied());
  rig_ = rig;
  if (sides_.empty() || step_ == Step::kSolved)
    step_ = Step::kSaved;
  return accept("rig " + rig.id() + " with " + std::to_string(rig.cameras.size()) +
                " cameras is in use");
}

void Calibration::setRig(const geometry::Rig& rig, const std::string& message) {
  rig_ = rig;
  if (sides_.empty() || step_ == Step::kSaved)
    step_ = Step::kSolved;
  message_ = message;
}

void Calibration::saved(const std::string& message) {
  if (step_ == Step::kSolved)
    step_ = Step::kSaved;
  message_ = message;
}

double Calibration::progress() const {
  if (capture_)
    return capture_->progress();
  if (busy_)
    return progress_;
  switch (step_) {
    case Step::kIdle:
      return 0.0;
    case Step::kReady:
      return static_cast<double>(corners_.size()) / static_cast<double>(kCorners);
    default:
      return 1.0;
  }
}

std::string Calibration::occupied() const {
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
  message_ = message;
  return {false, message};
}

Reply Calibration::accept(const std::string& message) {
  message_ = message;
  return {true, message};
}

/// The step between two requests, by what is captured.
void Calibration::settle() {
  step_ = corners_.size() == kCorners ? Step::kComplete : Step::kReady;
}

std::optional<std::size_t> Calibration::cornerInSamePlace(
    const capture::CapturedCorner& corner) const {
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    if (c == current_corner_)
      continue;
    bool seen_by_both = false;
    bool apart = false;
    for (const auto& view : corner) {
      const auto other = corners_[c].find(view.first);
      if (other == corners_[c].end())
        continue;
      seen_by_both = true;
      apart = apart || (view.second.pixel - other->second.pixel).norm() > kSamePlace;
    }
    if (seen_by_both && !apart)
      return c;
  }
  return std::nullopt;
}

}  // namespace wiimote_tracker::workflow
