#include "capture/corner_capture.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::capture {

namespace {

// The capture waits for a camera whose last sample is at most this old, and as long after the start
// for the first image of each camera.
constexpr double kHold = 0.5;  // [s]
// Fewest samples from which motion of the LED is judged.
constexpr std::size_t kSamplesToJudge = 10;

std::string pixels(double value) {
  return format("%.3f px", value);
}

}  // namespace

CornerCapture::CornerCapture(const std::vector<std::string>& cameras,
                             const CornerCaptureOptions& options,
                             double start_time)
    : options_(options), start_time_(start_time), now_(start_time) {
  for (const std::string& name : cameras)
    cameras_[name];
}

void CornerCapture::add(const Image& image) {
  const auto found = cameras_.find(image.camera);
  if (found == cameras_.end() || state_ != State::kCollecting)
    return;
  Camera& camera = found->second;
  const std::string clock = clockProblem(image.stamp);
  if (camera.clock.empty())
    camera.clock = clock;
  if (!clock.empty() || image.stamp < start_time_)
    return;
  camera.seen = true;
  camera.blobs = image.spots.size();
  camera.masked = image.masked.size();
  if (!isComplete(camera) && image.spots.size() == 1 && image.spots.front().allFinite()) {
    camera.spot.add(image.spots.front());
    camera.last_sample = image.stamp;
    const std::string moved = movement(camera.spot);
    if (!moved.empty())
      refuse(image.camera + ": " + moved);
  }
  update(image.stamp);
}

CornerCapture::State CornerCapture::update(double now) {
  now_ = std::max(now_, now);
  if (state_ != State::kCollecting)
    return state_;
  int complete = 0;
  bool waits = false;
  for (const auto& entry : cameras_) {
    if (isComplete(entry.second))
      ++complete;
    else if (entry.second.last_sample > now_ - kHold || isAwaited(entry.second))
      waits = true;
  }
  const bool timed_out = now_ - start_time_ >= options_.timeout;
  if (complete >= options_.minimum_cameras && (!waits || timed_out)) {
    state_ = State::kDone;
    message_ = "captured by " + std::to_string(complete) + " of " +
               std::to_string(cameras_.size()) + " cameras";
    const std::string left_out = leftOut();
    if (!left_out.empty())
      message_ += "; left out: " + left_out;
  } else if (timed_out) {
    refuse(std::to_string(complete) + " of at least " + std::to_string(options_.minimum_cameras) +
           " cameras saw the LED long enough before the time was up: " + leftOut());
  }
  return state_;
}

std::string CornerCapture::message() const {
  if (state_ != State::kCollecting)
    return message_;
  const std::string left_out = leftOut();
  return left_out.empty() ? "collecting" : "waits for: " + left_out;
}

double CornerCapture::progress() const {
  if (state_ == State::kDone)
    return 1.0;
  const double needed = options_.minimum_samples;
  double slowest = 1.0;
  int counted = 0;
  for (const auto& entry : cameras_) {
    if (entry.second.last_sample > now_ - kHold || isComplete(entry.second)) {
      slowest = std::min(slowest, static_cast<double>(entry.second.spot.samples()) / needed);
      ++counted;
    }
  }
  return counted >= options_.minimum_cameras ? slowest : 0.0;
}

std::string CornerCapture::problem(const std::string& name) const {
  const Camera& camera = cameras_.at(name);
  const std::string moved = movement(camera.spot);
  if (!moved.empty())
    return moved;
  if (isComplete(camera))
    return "";
  if (!camera.clock.empty())
    return camera.clock;
  if (!camera.seen && !isAwaited(camera))
    return kSendsNoImages;
  if (camera.blobs == 0 && camera.masked > 0)
    return "sees only masked lights: if the LED stands in front of one of them, move that "
           "lamp or the camera and learn the masks again";
  if (camera.seen && camera.blobs != 1)
    return spotCountProblem(camera.blobs);
  return "has " + std::to_string(camera.spot.samples()) + " of " +
         std::to_string(options_.minimum_samples) + " samples: keep the LED still";
}

CapturedCorner CornerCapture::result() const {
  CapturedCorner corner;
  for (const auto& entry : cameras_) {
    const StillSpot& spot = entry.second.spot;
    if (isComplete(entry.second))
      corner[entry.first] = CornerView{spot.mean(), spot.spread(), spot.samples()};
  }
  return corner;
}

/// Whether its first image may still come.
bool CornerCapture::isAwaited(const Camera& camera) const {
  return !camera.seen && now_ - start_time_ < std::min(kHold, options_.timeout);
}

bool CornerCapture::isComplete(const Camera& camera) const {
  return camera.spot.samples() >= static_cast<std::size_t>(options_.minimum_samples);
}

std::string CornerCapture::movement(const StillSpot& spot) const {
  if (spot.samples() < kSamplesToJudge)
    return "";
  const char* advice = "; keep the LED still and try again";
  if (spot.spread() > options_.spread_limit)
    return "the LED moved, its spot is spread over " + pixels(spot.spread()) + ", at most " +
           pixels(options_.spread_limit) + " are allowed" + advice;
  // The means of a noisy spot differ by chance, each having a variance of spread^2 over a third of
  // the samples: up to four standard deviations are no motion.
  const double chance = spot.spread() * std::sqrt(6.0 / static_cast<double>(spot.samples()));
  if (spot.samples() >= static_cast<std::size_t>(options_.minimum_samples) &&
      spot.drift() > std::max(options_.drift_limit, 4.0 * chance))
    return "the LED moved slowly, its spot drifted by " + pixels(spot.drift()) + ", at most " +
           pixels(options_.drift_limit) + " are allowed" + advice;
  return "";
}

/// By the clock that stamps the start: the capture begins before any of its images comes.
std::string CornerCapture::clockProblem(double stamp) const {
  if (stamp < start_time_)
    return stampProblem(stamp, start_time_ - stamp);
  // The other images, or update(), would have ended the capture before.
  const double ahead = stamp - now_;
  if (ahead > std::max(options_.timeout, kLongestDelay))
    return format(
        "sends images that are %.1f s ahead of the time by their stamps: set the clock of its "
        "computer",
        ahead);
  return "";
}

std::string CornerCapture::leftOut() const {
  std::vector<std::pair<std::string, std::string>> problems;
  for (const auto& entry : cameras_) {
    if (!isComplete(entry.second))
      problems.emplace_back(entry.first, problem(entry.first));
  }
  return listOfProblems(problems);
}

void CornerCapture::refuse(const std::string& message) {
  state_ = State::kRefused;
  message_ = message;
}

}  // namespace wiimote_tracker::capture
