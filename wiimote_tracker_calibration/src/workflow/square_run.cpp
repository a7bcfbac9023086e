#include "workflow/square_run.h"

#include "square/corner_order.h"

namespace wiimote_tracker::workflow {

namespace {

// An LED on the same corner as before appears within this distance of where it was [px].
constexpr double kSamePlace = 3.0;

}  // namespace

std::string SquareRun::nameOf(std::size_t corner) {
  return "corner " + std::to_string(corner + 1);
}

Reply SquareRun::begin(std::optional<std::size_t> retake, double now) {
  if (retake && *retake >= corners_.size())
    return refusal(nameOf(*retake) + " cannot be captured again, " +
                   std::to_string(corners_.size()) +
                   " are captured so far: take the next corner, or retake one of those");
  if (!retake && isComplete())
    return refusal("all four corners are captured: solve, or retake one of them");
  current_corner_ = retake.value_or(corners_.size());
  capture_.emplace(cameras_, options_, now);
  outcome_.reset();
  return {true, "capturing " + nameOf(current_corner_) + ": keep the LED still"};
}

void SquareRun::add(const capture::Image& image) {
  if (!capture_)
    return;
  capture_->add(image);
  finish();
}

void SquareRun::update(double now) {
  if (!capture_)
    return;
  capture_->update(now);
  finish();
}

void SquareRun::abandon(const std::string& why) {
  if (capture_)
    end(refusal(nameOf(current_corner_) + " was not captured: " + why));
}

void SquareRun::finish() {
  const capture::CornerCapture::State state = capture_->state();
  if (state == capture::CornerCapture::State::kCollecting)
    return;
  const std::string name = nameOf(current_corner_);
  if (state == capture::CornerCapture::State::kRefused)
    return abandon(capture_->message());
  const capture::CapturedCorner corner = capture_->result();
  if (const auto other = cornerInSamePlace(corner))
    return abandon("the LED is still where " + nameOf(*other) +
                   " was captured; carry it on and capture again");
  if (current_corner_ < corners_.size())
    corners_[current_corner_] = corner;
  else
    corners_.push_back(corner);
  end({true, name + " " + capture_->message() + "; " + next()});
}

void SquareRun::end(const Reply& outcome) {
  capture_.reset();
  outcome_ = outcome;
}

Reply SquareRun::undo() {
  if (corners_.empty())
    return refusal("there is no captured corner to undo");
  corners_.pop_back();
  return {true, nameOf(corners_.size()) + " was dropped: put the LED there and capture it"};
}

std::string SquareRun::next() const {
  if (isComplete())
    return std::string("all four corners are there") +
           (isClockwise()
                ? ", clockwise seen from above, so that z will point down: start again and "
                  "capture them counter-clockwise for z up, or go on; "
                : ": ") +
           "wave the LED through the volume, or solve";
  return "put the LED on " + nameOf(corners_.size()) + " and capture it";
}

bool SquareRun::isClockwise() const {
  for (const std::string& camera : cameras_) {
    std::vector<Eigen::Vector2d> pixels;
    for (const capture::CapturedCorner& corner : corners_) {
      const auto view = corner.find(camera);
      if (view != corner.end())
        pixels.push_back(view->second.pixel);
    }
    if (pixels.size() == kCorners && square::cornerOrder(pixels) == square::CornerOrder::kClockwise)
      return true;
  }
  return false;
}

std::optional<std::size_t> SquareRun::cornerInSamePlace(
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
