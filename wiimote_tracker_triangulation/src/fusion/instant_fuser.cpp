#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::fusion {
namespace {

double timeOffset(const geometry::RigCamera& camera, std::uint32_t clock_epoch) {
  switch (camera.time_offset_rule) {
    case geometry::TimeOffsetRule::kAlways:
      return camera.time_offset;
    case geometry::TimeOffsetRule::kOneEpoch:
      return clock_epoch == camera.time_offset_epoch ? camera.time_offset : 0.0;
    case geometry::TimeOffsetRule::kNone:
      break;
  }
  return 0.0;
}

bool isMasked(const geometry::RigCamera& camera, const Eigen::Vector2d& pixel) {
  return std::any_of(camera.masks.begin(), camera.masks.end(),
                     [&](const auto& mask) { return (pixel - mask.center).norm() <= mask.radius; });
}

}  // namespace

InstantFuser::InstantFuser(const geometry::Rig& rig, const InstantFuserOptions& options)
    : rig_(rig), options_(options) {
  rig_.check();
  for (const geometry::RigCamera& camera : rig_.cameras)
    cameras_.push_back({camera.camera, rig_.rayCamera(camera), &camera, {}});
  instant_.sightings.resize(cameras_.size());
  observations_.reserve(cameras_.size());
  subset_.reserve(cameras_.size());
  observers_.reserve(cameras_.size());
}

void InstantFuser::add(std::size_t camera_index, const CameraImage& image) {
  CameraState& camera = cameras_.at(camera_index);
  const Frame frame = frameOf(camera, image);
  if (!std::isfinite(frame.time) || !std::isfinite(frame.arrival))
    return;
  if (!started_) {
    reset(frame.arrival);
  } else if (frame.time < newest_time_ - kJump) {
    ++resets_;
    emitted_until_ = -std::numeric_limits<double>::infinity();
    reset(frame.arrival);
  }
  newest_arrival_ = std::max(newest_arrival_, frame.arrival);
  newest_time_ = std::max(newest_time_, frame.time);

  const bool is_newest = camera.frames.empty() || frame.time > camera.frames.newest().time;
  if (!is_newest || frame.time <= emitted_until_)
    ++late_frames_;
  if (is_newest)
    camera.frames.push(frame);
}

const Instant* InstantFuser::next() {
  double time = std::numeric_limits<double>::infinity();
  for (const CameraState& camera : cameras_)
    time = std::min(time, camera.frames.firstTimeAfter(emitted_until_).value_or(time));
  if (!(time <= reachedByAll()))
    return nullptr;
  emitted_until_ = time;
  instant_.time = time;
  collectSightings();
  locate();
  for (CameraState& camera : cameras_)
    camera.frames.forgetBefore(time);
  return &instant_;
}

void InstantFuser::continueFrom(double time, std::uint64_t late_frames) {
  emitted_until_ = time;
  late_frames_ = late_frames;
}

void InstantFuser::reset(double arrival) {
  started_ = true;
  started_at_ = arrival;
  newest_arrival_ = arrival;
  newest_time_ = -std::numeric_limits<double>::infinity();
  for (CameraState& camera : cameras_)
    camera.frames.clear();
}

Frame InstantFuser::frameOf(const CameraState& camera, const CameraImage& image) const {
  Frame frame;
  frame.time = image.stamp + timeOffset(*camera.calibration, image.clock_epoch);
  frame.arrival = image.arrival;
  int spots = 0;
  for (const Eigen::Vector2d& pixel : image.pixels) {
    if (isMasked(*camera.calibration, pixel))
      continue;
    frame.pixel = pixel;
    ++spots;
  }
  if (spots != 1)
    frame.pixel.reset();
  return frame;
}

/// The latest time up to which no active camera can still have something to say. Infinite when none
/// is active.
double InstantFuser::reachedByAll() const {
  double reached = std::numeric_limits<double>::infinity();
  for (const CameraState& camera : cameras_) {
    const bool heard = !camera.frames.empty();
    const double arrival = heard ? camera.frames.newest().arrival : started_at_;
    if (arrival < newest_arrival_ - options_.camera_timeout)
      continue;
    reached = std::min(
        reached, heard ? camera.frames.newest().time : -std::numeric_limits<double>::infinity());
  }
  return reached;
}

void InstantFuser::collectSightings() {
  instant_.latest_arrival = -std::numeric_limits<double>::infinity();
  instant_.skew = 0.0;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    Sighting& sighting = instant_.sightings[i];
    sighting = Sighting();
    const std::optional<Bracket> bracket = cameras_[i].frames.bracket(instant_.time);
    if (!bracket || bracket->gap() > options_.maximum_gap)
      continue;
    sighting.pixel = bracket->pixelAt(instant_.time);
    instant_.latest_arrival =
        std::max({instant_.latest_arrival, bracket->before->arrival, bracket->after->arrival});
    instant_.skew = std::max({instant_.skew, instant_.time - bracket->before->time,
                              bracket->after->time - instant_.time});
  }
}

void InstantFuser::locate() {
  observations_.clear();
  observers_.clear();
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (!instant_.sightings[i].pixel)
      continue;
    observations_.push_back({&cameras_[i].for_ray, *instant_.sightings[i].pixel});
    observers_.push_back(i);
  }
  instant_.point = geometry::triangulate(observations_, options_.triangulation);
  if (!fits(instant_.point))
    dropWorst();
  if (instant_.point)
    countRays();
}

bool InstantFuser::fits(const std::optional<geometry::TriangulatedPoint>& point) const {
  return point && point->reprojection_error <= options_.maximum_reprojection_error;
}

/// Takes out the one camera without which the others agree best; no point when they still do not.
void InstantFuser::dropWorst() {
  instant_.point.reset();
  if (observations_.size() < 3)
    return;
  std::size_t worst = 0;
  for (std::size_t left_out = 0; left_out < observations_.size(); ++left_out) {
    subset_.clear();
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (i != left_out)
        subset_.push_back(observations_[i]);
    }
    const auto point = geometry::triangulate(subset_, options_.triangulation);
    if (fits(point) &&
        (!instant_.point || point->reprojection_error < instant_.point->reprojection_error)) {
      instant_.point = point;
      worst = left_out;
    }
  }
  if (instant_.point)
    observers_.erase(observers_.begin() + static_cast<std::ptrdiff_t>(worst));
}

void InstantFuser::countRays() {
  instant_.rays_used = observers_.size();
  instant_.rays_possible = 0;
  instant_.last_observed = -std::numeric_limits<double>::infinity();
  for (const std::size_t i : observers_) {
    instant_.sightings[i].used = true;
    const Frame& before = *cameras_[i].frames.bracket(instant_.time)->before;
    instant_.last_observed = std::max(instant_.last_observed, before.time);
  }
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (instant_.sightings[i].used || cameras_[i].real.sees(instant_.point->position))
      ++instant_.rays_possible;
  }
}

}  // namespace wiimote_tracker::fusion
