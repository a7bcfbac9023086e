#include "image_update.h"

#include "image_assignment.h"
#include "merged_spots.h"

#include <algorithm>
#include <optional>

namespace wiimote_tracker::tracking {
namespace {

/// Whether errors of the calibration may have moved an LED's spot out of its gate: to the nearest
/// unassigned spot.
bool isExplained(const ImageAssignment& assignment, const Candidate& candidate) {
  const auto spot = assignment.nearestUnassigned(candidate.pixel(), kFarthestByCalibration);
  return spot && isByCalibration(assignment.rig, candidate.track->filter().position(),
                                 assignment.image.camera, candidate.others,
                                 assignment.image.pixels[*spot] - candidate.pixel(),
                                 candidate.prediction.covariance());
}

/// Compares the image with the LEDs that other cameras see. While two cameras do not fit each
/// other, an LED counts as shown only if its rays meet, and unassigned spots that both have count
/// as missing LEDs.
void measureFit(const ImageAssignment& assignment, CameraStates* cameras) {
  const StoredImage& image = assignment.image;
  const bool is_pair = cameras->size() == 2;
  CameraFit& fit = cameras->at(image.camera).fit;
  const bool is_tested = is_pair && fit.isMisfit();
  const auto& candidates = assignment.candidates;
  std::size_t unassigned =
      image.spot_count - std::count_if(candidates.begin(), candidates.end(),
                                       [](auto& candidate) { return candidate.spot.has_value(); });
  LedFit leds = image.bodies;
  for (const auto& [camera, state] : *cameras) {
    if (is_tested && camera != image.camera)
      leds.missing += std::min(unassigned, state.fit.unassigned());
  }
  for (const Candidate& candidate : candidates) {
    const Track& track = *candidate.track;
    const std::size_t others = candidate.others.size();
    if (!candidate.in_view || !track.isConfirmed() || others == 0)
      continue;
    const bool is_astray = candidate.spot && is_tested && !track.raysMeet();
    const bool is_absent =
        !candidate.spot && others >= (is_pair ? 1 : 2) && !mayBeMerged(assignment, candidate);
    leds.shown += candidate.spot && !is_astray;
    leds.missing += is_astray || is_absent;
    leds.explained += is_absent && isExplained(assignment, candidate);
    unassigned += is_astray;
  }
  fit.add(leds, unassigned);
}

/// Of the LED's spot or, since an image of a wrong time shows it outside the gate, the nearest
/// unassigned spot. Nothing near other LEDs, whose spots might be taken for its own or merged with
/// it.
std::optional<Eigen::Vector2d> residualOf(const ImageAssignment& assignment,
                                          const Candidate& candidate) {
  constexpr double kFarthest = 30.0;  // [px]
  const double apart = std::max(kFarthest, assignment.options.merging_distance);
  for (const Candidate& other : assignment.candidates) {
    if (other.track != candidate.track && (candidate.pixel() - other.pixel()).norm() < apart)
      return std::nullopt;
  }
  const auto spot =
      candidate.spot ? candidate.spot : assignment.nearestUnassigned(candidate.pixel(), kFarthest);
  return spot ? std::make_optional<Eigen::Vector2d>(assignment.image.pixels[*spot] -
                                                    candidate.pixel())
              : std::nullopt;
}

/// Compares the image with the motion of LEDs that two other cameras see.
void measureClock(const ImageAssignment& assignment, OffsetRegression* clock) {
  constexpr double kLeastSpeed = 0.1;  // of an LED that tells about time [m/s]
  for (const Candidate& candidate : assignment.candidates) {
    if (!candidate.in_view || !candidate.track->isConfirmed() || candidate.others.size() < 2)
      continue;
    const auto residual = residualOf(assignment, candidate);
    if (residual && candidate.track->filter().velocity().norm() >= kLeastSpeed)
      clock->add(candidate.pixel(), candidate.prediction.velocity(), *residual);
  }
}

/// The spot is of this LED, and perhaps of another one, too.
void updateBySpot(const ImageAssignment& assignment,
                  const Candidate& candidate,
                  const Candidate* merged) {
  const StoredImage& image = assignment.image;
  Track& track = *candidate.track;
  // Rays of two merged spots may meet where no LED is.
  if (!merged && !track.isConfirmed() && candidate.others.size() < 2)
    merged = shownByItsSpot(assignment, candidate);
  const Eigen::Vector2d& pixel = image.pixels[*candidate.spot];
  if (!track.update(assignment.camera.forRays(), candidate.prediction, pixel))
    return;
  const Eigen::Vector2d residual = pixel - candidate.pixel();
  track.hit(image.camera, residual, merged ? merged->track : nullptr, true);
  track.cameras().noteRay(image.camera,
                          assignment.camera.rayOffset(track.filter().position(), residual));
}

void updateTrack(const ImageAssignment& assignment, const Candidate& candidate) {
  const StoredImage& image = assignment.image;
  Track& track = *candidate.track;
  const Candidate* merged = mergedWith(assignment, candidate);
  if (merged && track.isConfirmed()) {
    if (candidate.others.empty())
      track.miss(image.camera, image.time);  // only this camera sees it: the spot is the other's
    else
      updateMerged(assignment, candidate, *merged);
  } else if (candidate.spot) {
    updateBySpot(assignment, candidate, merged);
  } else if (candidate.expected) {
    track.miss(image.camera, image.time);
  } else if (candidate.in_view && image.full) {
    track.cameras().noteSaturated(image.camera, image.time);
  }
}

}  // namespace

association::TrackOfSpot updateTracks(const GroupSetup& setup,
                                      const StoredImage& image,
                                      GroupState* state) {
  association::TrackOfSpot result;
  result.fill(association::kFalseDetection);
  ImageAssignment assignment = assignImage(setup, image, &state->tracks);
  CameraState& camera_state = state->cameras.at(image.camera);
  measureFit(assignment, &state->cameras);
  measureClock(assignment, &camera_state.offset_regression);
  if (camera_state.fit.isMisfit() && state->cameras.size() > 2)
    return result;
  updateMergedPairs(&state->pairs, &assignment);
  assignMergedSpots(&assignment);
  openMergedPairs(assignment, &state->pairs);
  for (const Candidate& candidate : assignment.candidates) {
    if (!candidate.updated)
      updateTrack(assignment, candidate);
    if (candidate.spot)
      result[*candidate.spot] = static_cast<int>(candidate.track - state->tracks.data());
  }
  return result;
}

}  // namespace wiimote_tracker::tracking
