#include "image_assignment.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

void addCandidate(Track* track, ImageAssignment* assignment) {
  constexpr double kEdge = 8.0;  // where a spot may be cut off, or just outside [px]
  const auto& [rig, camera, image, options, noise, candidates] = *assignment;
  if (!camera.mayShow(track->approximatePosition(image.time)))
    return;
  track->predict(image.time);
  const auto prediction = track->filter().predictPixel(camera.forRays(), noise);
  if (!prediction)
    return;
  const Eigen::Matrix2d covariance = prediction->covariance();
  // Without recent spots a prediction may be too uncertain for a single spot to confirm the track.
  // Then two cameras must reacquire it (see reacquiredBy). Blinking LEDs may just be dark.
  const double limit = 2.0 * options.birth_pixel_stddev;
  if (image.time - track->lastObserved() > options.birth_window + options.dark_time &&
      covariance.trace() > 2.0 * limit * limit)
    return;
  // Its spot may be in the image though its prediction is not.
  const Eigen::Vector2d& pixel = prediction->pixel();
  const double reach = std::sqrt(options.gate * covariance.trace());
  if (!camera.isInImage(pixel, std::max(options.merging_distance, reach)))
    return;
  const bool in_view = camera.isInImage(pixel, 0.0) && !camera.isMasked(pixel);
  const bool expected = in_view && !image.full && camera.isInImage(pixel, -kEdge);
  assignment->candidates.push_back(
      {track, *prediction,
       track->cameras().detecting(image.time - options.birth_window, image.camera), in_view,
       expected, std::nullopt, false});
}

/// Negative log likelihoods. The density of a spot is that of its track's prediction, or uniform
/// over the image for a false detection.
association::SpotCosts costsOf(const ImageAssignment& assignment) {
  constexpr double kUncertainTrackCost = 3.0;  // tentative, or seen by this camera only
  const auto& [rig, camera, image, options, noise, candidates] = assignment;
  const double detection_cost = -std::log(options.detection_probability);
  const double miss_cost = -std::log(1.0 - options.detection_probability);
  association::SpotCosts costs;
  costs.reset(image.spot_count, candidates.size(),
              -std::log(options.ghost_rate / camera.imageArea()), miss_cost);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (!candidate.expected)  // a missed detection costs no more than a detection
      costs.miss[i] = detection_cost;
    const bool is_certain = candidate.track->isConfirmed() && !candidate.others.empty();
    const double extra = detection_cost + (is_certain ? 0.0 : kUncertainTrackCost);
    for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
      if (const auto likelihood =
              candidate.prediction.logLikelihoodWithin(options.gate, image.pixels[spot]))
        costs.pair[spot][i] = extra - *likelihood;
    }
  }
  return costs;
}

}  // namespace

bool ImageAssignment::isUnassigned(std::size_t spot) const {
  return std::none_of(candidates.begin(), candidates.end(),
                      [&](const Candidate& candidate) { return candidate.spot == spot; });
}

std::optional<std::size_t> ImageAssignment::nearestUnassigned(const Eigen::Vector2d& pixel,
                                                              double distance) const {
  std::optional<std::size_t> nearest;
  for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
    const double to_spot = (image.pixels[spot] - pixel).norm();
    if (to_spot < distance && isUnassigned(spot)) {
      distance = to_spot;
      nearest = spot;
    }
  }
  return nearest;
}

Candidate* ImageAssignment::find(std::uint32_t id) {
  const auto found = std::find_if(candidates.begin(), candidates.end(),
                                  [&](auto& candidate) { return candidate.track->id() == id; });
  return found == candidates.end() ? nullptr : &*found;
}

ImageAssignment assignImage(const GroupSetup& setup,
                            const StoredImage& image,
                            std::vector<Track>* tracks) {
  const TrackerCamera& camera = setup.cameras[image.camera];
  ImageAssignment result{setup.rig, camera, image, setup.options, camera.noise(image.stamp_stddev),
                         {}};
  for (Track& track : *tracks) {
    if (result.candidates.size() < association::kMaximumTracks)
      addCandidate(&track, &result);
  }
  const association::TrackOfSpot candidate_of_spot = association::assignSpots(costsOf(result));
  for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
    if (candidate_of_spot[spot] != association::kFalseDetection)
      result.candidates[candidate_of_spot[spot]].spot = spot;
  }
  return result;
}

}  // namespace wiimote_tracker::tracking
