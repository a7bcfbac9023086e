#include "image_update.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::tracking {

ImageUpdate::ImageUpdate(const geometry::Rig& rig, const TrackerOptions& options)
    : rig_(rig), options_(options) {
  candidates_.reserve(association::kMaximumTracks);
}

void ImageUpdate::apply(const TrackerCamera& camera, const StoredImage& image, GroupState* state) {
  camera_ = &camera;
  image_ = &image;
  state_ = state;
  noise_ = camera.noise(image.stamp_stddev);
  collectCandidates();
  assign();
  measureFit();
  measureClock();
  if (state->cameras.at(image.camera).fit.isMisfit() && state->cameras.size() > 2) {
    track_of_spot_.fill(association::kFalseDetection);
    return;
  }
  updateMergedPairs();
  findMergedSpots();
  addMergedPairs();
  for (const Candidate& candidate : candidates_) {
    if (candidate.updated)
      continue;
    const Candidate* other = mergedWith(candidate);
    // A merged spot is the other's if only this camera sees this LED.
    const bool is_merged = other && candidate.track->isConfirmed();
    if (is_merged && !othersSeeing(*candidate.track).empty())
      updateMerged(candidate, *other);
    else if (!is_merged && candidate.spot)
      updateTrack(candidate, other);
    else if (is_merged || candidate.expected)
      candidate.track->miss(image.camera, image.time);
    else if (candidate.in_view && image.full)
      candidate.track->noteSaturated(image.camera, image.time);
  }
}

void ImageUpdate::collectCandidates() {
  constexpr double kEdge = 8.0;  // where a spot may be cut off, or just outside [px]
  candidates_.clear();
  for (Track& track : state_->tracks) {
    if (candidates_.size() == association::kMaximumTracks)
      return;
    if (!camera_->mayShow(track.approximatePosition(image_->time)))
      continue;
    track.filter.predict(image_->time);
    const auto prediction = track.filter.predictPixel(camera_->forRays(), noise_);
    if (!prediction || isTooUncertain(track, *prediction))
      continue;
    // Its spot may be in the image though its prediction is not.
    const double reach = std::sqrt(options_.gate * prediction->covariance().trace());
    if (!camera_->isInImage(prediction->pixel(), std::max(options_.merging_distance, reach)))
      continue;
    const bool in_view =
        camera_->isInImage(prediction->pixel(), 0.0) && !camera_->isMasked(prediction->pixel());
    const bool expected =
        in_view && !image_->full && camera_->isInImage(prediction->pixel(), -kEdge);
    candidates_.push_back({&track, *prediction, in_view, expected, std::nullopt, false});
  }
}

/// Without recent spots a prediction may be too uncertain for a single spot to confirm the track.
/// Then two cameras must reacquire it (see TrackInitiation). Blinking LEDs may just be dark.
bool ImageUpdate::isTooUncertain(const Track& track,
                                 const motion::PixelPrediction& prediction) const {
  const double limit = 2.0 * options_.birth_pixel_stddev;
  return image_->time - track.lastObserved() > options_.birth_window + options_.dark_time &&
         prediction.covariance().trace() > 2.0 * limit * limit;
}

/// Other cameras that saw the track's LED lately.
CameraList ImageUpdate::othersSeeing(const Track& track) const {
  return track.othersSeeing(image_->camera, image_->time - options_.birth_window);
}

/// Compares the image with the LEDs that other cameras see. While two cameras do not fit each
/// other, an LED counts as shown only if its rays meet, and unassigned spots that both have count
/// as missing LEDs.
void ImageUpdate::measureFit() const {
  const bool is_pair = state_->cameras.size() == 2;
  CameraFit& fit = state_->cameras.at(image_->camera).fit;
  const bool is_tested = is_pair && fit.isMisfit();
  const auto end = track_of_spot_.begin() + image_->spot_count;
  std::size_t unassigned = std::count(track_of_spot_.begin(), end, association::kFalseDetection);
  LedFit leds = image_->bodies;
  for (const auto& [camera, state] : state_->cameras) {
    if (is_tested && camera != image_->camera)
      leds.missing += std::min(unassigned, state.fit.unassigned());
  }
  for (const Candidate& candidate : candidates_) {
    const Track& track = *candidate.track;
    const std::size_t others = othersSeeing(track).size();
    if (!candidate.in_view || !track.isConfirmed() || others == 0)
      continue;
    const bool is_astray = candidate.spot && is_tested && !track.raysMeet();
    const bool is_absent =
        !candidate.spot && others >= (is_pair ? 1 : 2) && !mayBeMerged(candidate);
    leds.shown += candidate.spot && !is_astray;
    leds.missing += is_astray || is_absent;
    leds.explained += is_absent && isExplained(candidate);
    unassigned += is_astray;
  }
  fit.add(leds, unassigned);
}

/// Whether errors of the calibration may have moved an LED's spot out of its gate: to the nearest
/// spot that is unassigned.
bool ImageUpdate::isExplained(const Candidate& candidate) const {
  const Eigen::Vector2d& predicted = candidate.prediction.pixel();
  const auto spot = nearestUnassigned(predicted, kFarthestByCalibration);
  if (!spot)
    return false;
  return isByCalibration(rig_, candidate.track->filter.position(), image_->camera,
                         othersSeeing(*candidate.track), image_->pixels[*spot] - predicted,
                         candidate.prediction.covariance());
}

/// Compares the image with the motion of LEDs that two other cameras see.
void ImageUpdate::measureClock() const {
  constexpr double kLeastSpeed = 0.1;  // of an LED that tells about time [m/s]
  for (const Candidate& candidate : candidates_) {
    const Track& track = *candidate.track;
    if (!candidate.in_view || !track.isConfirmed() || othersSeeing(track).size() < 2)
      continue;
    const auto residual = residualOf(candidate);
    if (!residual || !(track.filter.velocity().norm() >= kLeastSpeed))
      continue;
    state_->cameras.at(image_->camera)
        .clock_regression.add(candidate.prediction.pixel(), candidate.prediction.velocity(),
                              *residual);
  }
}

/// Whether another LED is within a distance [px].
bool ImageUpdate::isBeside(const Candidate& candidate, double distance) const {
  return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& other) {
    return other.track != candidate.track && pixelsBetween(candidate, other) < distance;
  });
}

/// Of the LED's spot or, since an image of a wrong time shows it outside the gate, the nearest spot
/// that belongs to no LED. Nothing near other LEDs, whose spots might be taken for its own or
/// merged with it.
std::optional<Eigen::Vector2d> ImageUpdate::residualOf(const Candidate& candidate) const {
  constexpr double kFarthest = 30.0;  // [px]
  if (isBeside(candidate, std::max(kFarthest, options_.merging_distance)))
    return std::nullopt;
  const Eigen::Vector2d& predicted = candidate.prediction.pixel();
  const auto spot = candidate.spot ? candidate.spot : nearestUnassigned(predicted, kFarthest);
  return spot ? std::make_optional<Eigen::Vector2d>(image_->pixels[*spot] - predicted)
              : std::nullopt;
}

/// Costs are negative log likelihoods. The density of a spot is that of its track's prediction, or
/// uniform over the image for a false detection. A track takes only spots in its gate.
void ImageUpdate::assign() {
  constexpr double kUncertainTrackCost = 3.0;  // tentative, or seen by this camera only
  const double detection_cost = -std::log(options_.detection_probability);
  const double miss_cost = -std::log(1.0 - options_.detection_probability);
  costs_.reset(image_->spot_count, candidates_.size(),
               -std::log(options_.ghost_rate / camera_->imageArea()), miss_cost);
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    if (!candidate.expected)  // a missed detection costs no more than a detection
      costs_.miss[i] = detection_cost;
    const bool is_certain =
        candidate.track->isConfirmed() && !othersSeeing(*candidate.track).empty();
    const double extra = detection_cost + (is_certain ? 0.0 : kUncertainTrackCost);
    for (std::size_t spot = 0; spot < image_->spot_count; ++spot) {
      if (const auto likelihood =
              candidate.prediction.logLikelihoodWithin(options_.gate, image_->pixels[spot]))
        costs_.pair[spot][i] = extra - *likelihood;
    }
  }
  const auto candidate_of_spot = association::assignSpots(costs_);
  track_of_spot_.fill(association::kFalseDetection);
  for (std::size_t spot = 0; spot < image_->spot_count; ++spot) {
    if (candidate_of_spot[spot] == association::kFalseDetection)
      continue;
    assignSpot(spot, &candidates_[candidate_of_spot[spot]]);
  }
}

void ImageUpdate::updateTrack(const Candidate& candidate, const Candidate* other) const {
  Track& track = *candidate.track;
  const Eigen::Vector2d& pixel = image_->pixels[*candidate.spot];
  if (!track.filter.update(camera_->forRays(), candidate.prediction, pixel))
    return;
  const Eigen::Vector2d residual = pixel - candidate.prediction.pixel();
  track.hit(image_->camera, residual, other ? other->track : nullptr, true);
  track.noteRay(image_->camera, camera_->rayOffset(track.filter.position(), residual));
}

void ImageUpdate::assignSpot(std::size_t spot, Candidate* candidate) {
  candidate->spot = spot;
  track_of_spot_[spot] = static_cast<int>(candidate->track - state_->tracks.data());
}

ImageUpdate::Candidate* ImageUpdate::find(std::uint32_t id) {
  const auto found = std::find_if(candidates_.begin(), candidates_.end(),
                                  [&](auto& candidate) { return candidate.track->id == id; });
  return found == candidates_.end() ? nullptr : &*found;
}

}  // namespace wiimote_tracker::tracking
