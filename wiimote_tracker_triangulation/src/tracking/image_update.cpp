#include "image_update.h"

#include "wiimote_tracker_triangulation/geometry/point_sensitivity.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::tracking {

ImageUpdate::ImageUpdate(const geometry::Rig& rig,
                         const std::vector<std::size_t>& members,
                         const TrackerOptions& options)
    : rig_(rig), members_(members), options_(options) {
  candidates_.reserve(association::kMaximumTracks);
}

void ImageUpdate::apply(const GroupCamera& camera,
                        const StoredImage& image,
                        std::vector<CameraFit>* fits,
                        std::vector<Track>* tracks,
                        std::vector<MergedPair>* pairs) {
  noise_ = camera.noise(image.stamp_stddev);
  collectCandidates(camera, image, tracks);
  assign(camera, image, *tracks);
  measureFit(image, *tracks, fits);
  measureClock(image, *tracks, fits);
  if ((*fits)[image.camera].isMisfit() && fits->size() > 2) {
    track_of_spot_.fill(association::kFalseDetection);
    return;
  }
  updateMergedPairs(camera, image, tracks, pairs);
  findMergedSpots(image, *tracks);
  addMergedPairs(image, *tracks, pairs);
  for (const Candidate& candidate : candidates_) {
    Track& track = (*tracks)[candidate.track];
    if (candidate.updated)
      continue;
    const Candidate* other = mergedWith(image, candidate, *tracks);
    // A merged spot is the other's if only this camera sees this LED.
    const bool is_merged = other && track.isConfirmed();
    if (is_merged && othersSeeing(image, track) > 0)
      updateMerged(camera, image, candidate, *other, tracks);
    else if (!is_merged && candidate.spot)
      updateTrack(camera, image, candidate, other ? &(*tracks)[other->track] : nullptr, &track);
    else if (is_merged || candidate.expected)
      track.miss(image.camera, image.time);
    else if (candidate.in_view && image.full)
      track.crowdOut(image.camera, image.time);
  }
}

void ImageUpdate::collectCandidates(const GroupCamera& camera,
                                    const StoredImage& image,
                                    std::vector<Track>* tracks) {
  constexpr double kEdge = 8.0;  // where a spot may be cut off, or just outside [px]
  candidates_.clear();
  for (std::size_t i = 0; i < tracks->size(); ++i) {
    Track& track = (*tracks)[i];
    if (candidates_.size() == association::kMaximumTracks)
      return;
    if (!camera.mayShow(track.approximatePosition(image.time)))
      continue;
    track.filter.predict(image.time);
    const auto prediction = track.filter.predictPixel(camera.forRays(), noise_);
    if (!prediction || isTooUncertain(track, *prediction, image.time))
      continue;
    // Its spot may be in the image though its prediction is not.
    const double reach = std::sqrt(options_.gate * prediction->covariance().trace());
    if (!camera.isInImage(prediction->pixel(), std::max(options_.merging_distance, reach)))
      continue;
    const bool in_view =
        camera.isInImage(prediction->pixel(), 0.0) && !camera.isMasked(prediction->pixel());
    const bool expected = in_view && !image.full && camera.isInImage(prediction->pixel(), -kEdge);
    candidates_.push_back({i, *prediction, in_view, expected, std::nullopt, false});
  }
}

/// Without recent spots a prediction may be too uncertain for a single spot to confirm the track.
/// Then two cameras must reacquire it (see TrackInitiation). Blinking LEDs may just be dark.
bool ImageUpdate::isTooUncertain(const Track& track,
                                 const motion::PixelPrediction& prediction,
                                 double time) const {
  const double limit = 2.0 * options_.birth_pixel_stddev;
  return time - track.lastObserved() > options_.birth_window + options_.dark_time &&
         prediction.covariance().trace() > 2.0 * limit * limit;
}

/// Other cameras that saw the track's LED lately.
std::size_t ImageUpdate::othersSeeing(const StoredImage& image, const Track& track) const {
  return track.othersSeeing(image.camera, image.time - options_.birth_window);
}

/// Compares the image with the LEDs that other cameras see. Two cameras that did not fit each other
/// have to show that the rays of each LED meet; of spots that both have and that form no LED, there
/// ought to be none.
void ImageUpdate::measureFit(const StoredImage& image,
                             const std::vector<Track>& tracks,
                             std::vector<CameraFit>* fits) const {
  const bool is_pair = fits->size() == 2;
  CameraFit& fit = (*fits)[image.camera];
  const bool is_tested = is_pair && fit.isMisfit();
  const auto end = track_of_spot_.begin() + static_cast<std::ptrdiff_t>(image.spot_count);
  auto unassigned = static_cast<std::size_t>(
      std::count(track_of_spot_.begin(), end, association::kFalseDetection));
  std::size_t shown = 0;
  std::size_t missing =
      is_tested ? std::min(unassigned, (*fits)[1 - image.camera].unassigned()) : 0;
  std::size_t explained = 0;
  for (const Candidate& candidate : candidates_) {
    const Track& track = tracks[candidate.track];
    const std::size_t others = othersSeeing(image, track);
    if (!candidate.in_view || !track.isConfirmed() || others == 0)
      continue;
    const bool is_astray = candidate.spot && is_tested && !track.raysMeet();
    const bool is_absent =
        !candidate.spot && others >= (is_pair ? 1 : 2) && !mayBeMerged(image, candidate, tracks);
    shown += candidate.spot && !is_astray;
    missing += is_astray || is_absent;
    explained += is_absent && isExplained(image, candidate, track);
    unassigned += is_astray;
  }
  fit.add(shown, missing, unassigned, explained);
}

/// Whether errors of the calibration may have moved an LED's spot out of its gate: to the nearest
/// spot that is unassigned.
bool ImageUpdate::isExplained(const StoredImage& image,
                              const Candidate& candidate,
                              const Track& track) const {
  constexpr double kFarthest = 64.0;        // however vague the calibration is [px]
  constexpr double kSquaredDistance = 9.0;  // three standard deviations
  const Eigen::Vector2d& predicted = candidate.prediction.pixel();
  const auto spot = nearestUnassigned(image, predicted, kFarthest);
  if (!spot)
    return false;
  std::array<std::size_t, geometry::kMaximumOthers> others;
  const std::size_t count =
      track.othersSeeing(image.camera, image.time - options_.birth_window, &others);
  for (std::size_t i = 0; i < count; ++i)
    others[i] = members_[others[i]];
  const auto of_calibration = geometry::disagreementCovariance(
      rig_, track.filter.position(), members_[image.camera], others.data(), count);
  if (!of_calibration)
    return false;
  const Eigen::Matrix2d covariance = candidate.prediction.covariance() + *of_calibration;
  const Eigen::Vector2d residual = image.pixels[*spot] - predicted;
  return residual.dot(covariance.inverse() * residual) <= kSquaredDistance;
}

/// Compares the image with the motion of LEDs that two other cameras see.
void ImageUpdate::measureClock(const StoredImage& image,
                               const std::vector<Track>& tracks,
                               std::vector<CameraFit>* fits) const {
  constexpr double kLeastSpeed = 0.1;  // of an LED that tells about time [m/s]
  CameraFit& fit = (*fits)[image.camera];
  for (const Candidate& candidate : candidates_) {
    const Track& track = tracks[candidate.track];
    if (!candidate.in_view || !track.isConfirmed() || othersSeeing(image, track) < 2)
      continue;
    const auto residual = residualOf(image, candidate);
    if (!residual || !(track.filter.velocity().norm() >= kLeastSpeed))
      continue;
    fit.clock.add(candidate.prediction.pixel(), candidate.prediction.velocity(), *residual);
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
std::optional<Eigen::Vector2d> ImageUpdate::residualOf(const StoredImage& image,
                                                       const Candidate& candidate) const {
  constexpr double kFarthest = 30.0;  // [px]
  if (isBeside(candidate, std::max(kFarthest, options_.merging_distance)))
    return std::nullopt;
  const Eigen::Vector2d& predicted = candidate.prediction.pixel();
  const auto spot =
      candidate.spot ? candidate.spot : nearestUnassigned(image, predicted, kFarthest);
  return spot ? std::make_optional<Eigen::Vector2d>(image.pixels[*spot] - predicted) : std::nullopt;
}

/// Costs are negative log likelihoods. The density of a spot is that of its track's prediction, or
/// uniform over the image for a false detection.
void ImageUpdate::assign(const GroupCamera& camera,
                         const StoredImage& image,
                         const std::vector<Track>& tracks) {
  constexpr double kUncertainTrackCost = 3.0;  // tentative, or seen by this camera only
  const double detection_cost = -std::log(options_.detection_probability);
  const double miss_cost = -std::log(1.0 - options_.detection_probability);
  costs_.reset(image.spot_count, candidates_.size(),
               -std::log(options_.ghost_rate / camera.imageArea()), miss_cost);
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    if (!candidate.expected)  // a missed detection costs no more than a detection
      costs_.miss[i] = detection_cost;
    const Track& track = tracks[candidate.track];
    const bool is_certain = track.isConfirmed() && othersSeeing(image, track) > 0;
    const double extra = detection_cost + (is_certain ? 0.0 : kUncertainTrackCost);
    for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
      if (const auto likelihood =
              candidate.prediction.logLikelihoodWithin(options_.gate, image.pixels[spot]))
        costs_.pair[spot][i] = extra - *likelihood;
    }
  }
  const association::SpotAssignment best = association::assignSpots(costs_);
  track_of_spot_.fill(association::kFalseDetection);
  for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
    if (best.track_of_spot[spot] == association::kFalseDetection)
      continue;
    assignSpot(spot, &candidates_[static_cast<std::size_t>(best.track_of_spot[spot])]);
  }
}

void ImageUpdate::updateTrack(const GroupCamera& camera,
                              const StoredImage& image,
                              const Candidate& candidate,
                              const Track* other,
                              Track* track) const {
  const Eigen::Vector2d& pixel = image.pixels[*candidate.spot];
  if (!track->filter.update(camera.forRays(), candidate.prediction, pixel))
    return;
  const Eigen::Vector2d residual = pixel - candidate.prediction.pixel();
  track->hit(image.camera, residual, true);
  track->noteRay(image.camera, camera.rayOffset(track->filter.position(), residual));
  if (other)
    track->noteSharedSpot(other->id, true);
  else
    track->noteOwnSpot();
}

void ImageUpdate::assignSpot(std::size_t spot, Candidate* candidate) {
  candidate->spot = spot;
  track_of_spot_[spot] = static_cast<int>(candidate->track);
}

ImageUpdate::Candidate* ImageUpdate::find(const std::vector<Track>& tracks, std::uint32_t id) {
  const auto found = std::find_if(candidates_.begin(), candidates_.end(), [&](auto& candidate) {
    return tracks[candidate.track].id == id;
  });
  return found == candidates_.end() ? nullptr : &*found;
}

}  // namespace wiimote_tracker::tracking
