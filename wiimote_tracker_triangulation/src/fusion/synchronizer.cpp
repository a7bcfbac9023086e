#include "synchronizer.h"

#include "association/assign_spots.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::fusion {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool hasImageAt(const FrameHistory<Frame>& frames, double time) {
  const Frame* frame = frames.lastUpTo(time);
  return frame && frame->time == time;
}

}  // namespace

void followSpots(const Frame& before, double maximum_speed, Frame* frame) {
  constexpr double kOtherSlot = 3.0 * 3.0;  // cost of a changed slot [px^2]
  const double elapsed = frame->time - before.time;
  const double gate_squared = maximum_speed * maximum_speed * elapsed * elapsed;
  association::SpotCosts costs;
  // A pair costs at most as much as two unassigned spots.
  costs.reset(std::min(frame->spots.size(), association::kMaximumSpots),
              std::min(before.spots.size(), association::kMaximumSpots),
              0.5 * (gate_squared + kOtherSlot), 0.5 * (gate_squared + kOtherSlot));
  for (std::size_t i = 0; i < costs.spots; ++i) {
    const FrameSpot& spot = frame->spots[i];
    for (std::size_t j = 0; j < costs.tracks; ++j) {
      const FrameSpot& old = before.spots[j];
      const Eigen::Vector2d predicted = old.pixel + elapsed * old.velocity;
      const double distance_squared = (spot.pixel - predicted).squaredNorm();
      if (distance_squared <= gate_squared)
        costs.pair[i][j] = distance_squared + (spot.slot == old.slot ? 0.0 : kOtherSlot);
    }
  }
  const auto track_of_spot = association::assignSpots(costs);
  for (std::size_t i = 0; i < frame->spots.size(); ++i) {
    FrameSpot& spot = frame->spots[i];
    spot.before = kNoSpot;
    spot.velocity.setZero();
    if (i >= costs.spots || track_of_spot[i] == association::kFalseDetection)
      continue;
    spot.before = track_of_spot[i];
    const FrameSpot& old = before.spots[spot.before];
    spot.velocity = (spot.pixel - old.pixel) / elapsed;
  }
}

void Synchronizer::setRig(const geometry::Rig& rig) {
  cameras_.clear();
  for (const geometry::RigCamera& camera : rig.cameras)
    cameras_.push_back({camera, {}});
  views_.assign(cameras_.size(), InstantView());
  has_begun_ = false;
  former_arrival_ = newest_arrival_;
}

void Synchronizer::add(std::size_t camera_index,
                       const tracking::CameraImage& image,
                       tracking::Counters* counters) {
  CameraState& camera = cameras_.at(camera_index);
  readFrame(camera.calibration, image);
  if (!std::isfinite(frame_.time) || !std::isfinite(frame_.arrival)) {
    ++counters->dropped;
    return;
  }
  FrameHistory<Frame>& frames = camera.frames;
  noteArrival(frames, counters);
  if (!frames.empty() && !(frame_.time > frames.newest().time)) {
    if (hasImageAt(frames, frame_.time)) {
      ++counters->repeated;
    } else {
      ++counters->late;
      ++counters->dropped;
    }
    return;
  }
  if (frame_.time <= time_)
    ++counters->late;
  if (!frames.empty() && frame_.time - frames.newest().time <= options_.maximum_gap)
    followSpots(frames.newest(), options_.maximum_spot_speed, &frame_);
  frames.push(frame_);
}

/// Begins anew where the camera's image, or all cameras' after a new rig, arrived before earlier
/// ones.
void Synchronizer::noteArrival(const FrameHistory<Frame>& frames, tracking::Counters* counters) {
  if (!has_begun_) {
    begin(frame_.arrival);
  } else if (!frames.empty() && frame_.arrival < frames.newest().arrival - InstantFuser::kJump) {
    jumpBack(counters);
    begin(frame_.arrival);
  } else if (frame_.arrival < newest_arrival_) {
    ++counters->disordered;
  }
  newest_arrival_ = std::max(newest_arrival_, frame_.arrival);
  // A new rig's camera has no last image. So all are compared, once each had time for one.
  if (newest_arrival_ < former_arrival_ - InstantFuser::kJump &&
      newest_arrival_ >= begun_at_ + options_.camera_timeout)
    jumpBack(counters);
}

bool Synchronizer::advance() {
  double time = kInfinity;
  for (const CameraState& camera : cameras_)
    time = std::min(time, camera.frames.firstTimeAfter(time_).value_or(time));
  if (time == kInfinity || time > reachedByAll())
    return false;
  time_ = time;
  latest_arrival_ = -kInfinity;
  skew_ = 0.0;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    interpolate(cameras_[i], &views_[i]);
    cameras_[i].frames.forgetBefore(time_);
  }
  return true;
}

void Synchronizer::jumpBack(tracking::Counters* counters) {
  ++counters->resets;
  time_ = -kInfinity;
  former_arrival_ = -kInfinity;
}

void Synchronizer::begin(double arrival) {
  has_begun_ = true;
  begun_at_ = arrival;
  newest_arrival_ = arrival;
  for (CameraState& camera : cameras_)
    camera.frames.clear();
}

void Synchronizer::readFrame(const geometry::RigCamera& camera,
                             const tracking::CameraImage& image) {
  frame_.time = image.stamp + camera.timeOffsetIn(image.clock_epoch).value_or(0.0);
  frame_.arrival = image.arrival;
  frame_.is_full = image.spots.size() >= image.maximum_spots;
  frame_.spots.clear();
  frame_.masked.clear();
  for (const tracking::Spot& spot : image.spots) {
    if (geometry::isMasked(camera.masks, spot.pixel)) {
      frame_.masked.push_back(spot.pixel);
    } else {
      frame_.spots.push_back({spot, kNoSpot, Eigen::Vector2d::Zero()});
    }
  }
}

/// The latest time that all active cameras have reached. Infinite when none is active.
double Synchronizer::reachedByAll() const {
  double reached = kInfinity;
  for (const CameraState& camera : cameras_) {
    const bool heard = !camera.frames.empty();
    const double arrival = heard ? camera.frames.newest().arrival : begun_at_;
    if (arrival < newest_arrival_ - options_.camera_timeout)
      continue;
    reached = std::min(reached, heard ? camera.frames.newest().time : -kInfinity);
  }
  return reached;
}

void Synchronizer::interpolate(const CameraState& camera, InstantView* view) {
  view->spots.clear();
  view->time.reset();
  view->full = false;
  const auto bracket = camera.frames.bracket(time_);
  view->is_watching = bracket && bracket->gap() <= options_.maximum_gap;
  if (view->is_watching) {
    const Frame& before = *bracket->before;
    const Frame& after = *bracket->after;
    view->full = before.is_full || after.is_full;
    latest_arrival_ = std::max({latest_arrival_, before.arrival, after.arrival});
    skew_ = std::max({skew_, time_ - before.time, after.time - time_});
    const double share = bracket->shareAt(time_);
    for (const FrameSpot& spot : after.spots) {
      Eigen::Vector2d pixel = spot.pixel;
      if (&before != &after) {
        if (spot.before == kNoSpot)
          continue;
        const Eigen::Vector2d& start = before.spots[spot.before].pixel;
        pixel = start + share * (spot.pixel - start);
      }
      view->spots.push_back({pixel, tracking::SpotUse::kUnassigned, 0});
    }
  }
  if (const Frame* newest = camera.frames.lastUpTo(time_)) {
    view->time = newest->time;
    for (const Eigen::Vector2d& pixel : newest->masked)
      view->spots.push_back({pixel, tracking::SpotUse::kMasked, 0});
  }
}

}  // namespace wiimote_tracker::fusion
