// The part of ImageUpdate for LEDs that are so close in an image that they show one spot.
#include "image_update.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::tracking {
namespace {

/// Probability [0..1] that a spot is that of two merged LEDs, rather than of one while the other is
/// hidden. A merged spot is between both predictions, a single one at its own. The distance below
/// which two LEDs merge is uniform up to merging_distance, as far as we know.
/// @param visible, absent predictions of the LED that the spot was assigned to, and of the other
/// @param hidden prior probability that the absent one is hidden [0..1, exclusive]
double mergedProbability(const Eigen::Vector2d& spot,
                         const motion::PixelPrediction& visible,
                         const motion::PixelPrediction& absent,
                         double hidden,
                         double pixel_stddev,
                         double merging_distance) {
  constexpr double kSpread = 0.15;  // of the place between two LEDs, by their brightness [1]
  const Eigen::Vector2d between = absent.pixel() - visible.pixel();
  const double merging = 1.0 - between.norm() / merging_distance;  // prior probability
  if (merging <= 0.0)
    return 0.0;
  const Eigen::Vector2d residual = spot - visible.pixel() - 0.5 * between;
  // Of the spot about the middle. Half of the pixel noise comes with the two predictions.
  const Eigen::Matrix2d covariance =
      0.25 * (visible.covariance() + absent.covariance()) +
      0.5 * pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity() +
      kSpread * kSpread * between * between.transpose();
  const double merged = -0.5 * residual.dot(covariance.inverse() * residual) -
                        std::log(2.0 * M_PI * std::sqrt(covariance.determinant()));
  const double log_odds =
      merged - visible.logLikelihood(spot) + std::log((1.0 - hidden) * merging / hidden);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace

/// Whether an LED without a spot may be merged with another one, which has a spot or has none, too.
/// A tentative track without one may be of the LED itself.
bool ImageUpdate::mayBeMerged(const Candidate& candidate) const {
  return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& other) {
    return other.track != candidate.track &&
           pixelsBetween(candidate, other) < options_.merging_distance &&
           (other.spot || (other.track->isConfirmed() && spotBetween(candidate, other)));
  });
}

/// The unassigned spot that is nearest to a pixel, and nearer than this distance [px].
std::optional<std::size_t> ImageUpdate::nearestUnassigned(const Eigen::Vector2d& pixel,
                                                          double distance) const {
  std::optional<std::size_t> nearest;
  for (std::size_t spot = 0; spot < image_->spot_count; ++spot) {
    const double to_spot = (image_->pixels[spot] - pixel).norm();
    if (track_of_spot_[spot] == association::kFalseDetection && to_spot < distance) {
      distance = to_spot;
      nearest = spot;
    }
  }
  return nearest;
}

/// An unassigned spot between two LEDs that have none is the merged spot of both, if they are close
/// enough. It may be outside the gates of both.
std::optional<std::size_t> ImageUpdate::spotBetween(const Candidate& a, const Candidate& b) const {
  if (pixelsBetween(a, b) >= options_.merging_distance)
    return std::nullopt;
  const Eigen::Vector2d middle = 0.5 * (a.prediction.pixel() + b.prediction.pixel());
  return nearestUnassigned(middle, 0.5 * options_.merging_distance);
}

/// The LED that a candidate is most probably merged with in one spot, of which one of the two has
/// none.
const ImageUpdate::Candidate* ImageUpdate::mergedWith(const Candidate& candidate) const {
  const Candidate* result = nullptr;
  double greatest = 0.5;
  for (const Candidate& other : candidates_) {
    if (other.track == candidate.track || other.spot.has_value() == candidate.spot.has_value() ||
        !other.track->isConfirmed())
      continue;
    const Candidate& visible = other.spot ? other : candidate;
    const Candidate& absent = other.spot ? candidate : other;
    // An LED that was hidden from this camera mostly stays hidden.
    const double hidden = absent.track->wasMissedBy(image_->camera)
                              ? options_.detection_probability
                              : 1.0 - options_.detection_probability;
    const double probability =
        mergedProbability(image_->pixels[*visible.spot], visible.prediction, absent.prediction,
                          hidden, noise_.pixel_stddev, options_.merging_distance);
    if (probability > greatest) {
      greatest = probability;
      result = &other;
    }
  }
  return result;
}

void ImageUpdate::findMergedSpots() {
  const auto isAlone = [](const Candidate& candidate) {
    return !candidate.spot && candidate.track->isConfirmed();
  };
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    for (std::size_t j = i + 1; j < candidates_.size(); ++j) {
      Candidate &a = candidates_[i], &b = candidates_[j];
      const auto spot = isAlone(a) && isAlone(b) ? spotBetween(a, b) : std::nullopt;
      if (!spot)
        continue;
      const Eigen::Vector2d between = b.prediction.pixel() - a.prediction.pixel();
      const Eigen::Vector2d from_a = image_->pixels[*spot] - a.prediction.pixel();
      assignSpot(*spot, from_a.dot(between) > 0.5 * between.squaredNorm() ? &b : &a);
    }
  }
}

void ImageUpdate::addMergedPairs() const {
  std::vector<MergedPair>& pairs = state_->pairs;
  for (const Candidate& candidate : candidates_) {
    const Candidate* other = candidate.spot ? mergedWith(candidate) : nullptr;
    if (!other || !candidate.track->isConfirmed())
      continue;
    const Track& a = *candidate.track;
    const Track& b = *other->track;
    const bool is_known = std::any_of(pairs.begin(), pairs.end(), [&](const MergedPair& pair) {
      return pair.has(a.id) || pair.has(b.id);
    });
    if (!is_known && !a.isShownBeside(b, image_->time - options_.birth_window))
      pairs.emplace_back(a.id, b.id, MergedPair::Filters{a.filter, b.filter});
  }
}

/// Lets each pair choose the spots of its two LEDs in an image that shows both. Other images update
/// the two as any other track.
void ImageUpdate::updateMergedPairs() {
  for (MergedPair& pair : state_->pairs) {
    const std::array<Candidate*, 2> both = {find(pair.ids()[0]), find(pair.ids()[1])};
    if (!both[0] || !both[1])
      continue;
    MergedPair::View view;
    view.camera = &camera_->forRays();
    view.noise = noise_;
    view.time = image_->time;
    boost::container::static_vector<std::size_t, association::kMaximumSpots> spot_of;  // the view's
    for (std::size_t spot = 0; spot < image_->spot_count; ++spot) {
      const bool is_free = track_of_spot_[spot] == association::kFalseDetection;
      if (!is_free && both[0]->spot != spot && both[1]->spot != spot)
        continue;
      spot_of.push_back(spot);
      view.pixels.push_back(image_->pixels[spot]);
    }
    const auto chosen = pair.update(view, options_.gate);
    if (!chosen)
      continue;
    for (const std::size_t spot : spot_of)
      track_of_spot_[spot] = association::kFalseDetection;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t spot = spot_of[(*chosen)[i]];
      assignSpot(spot, both[i]);
      both[i]->updated = true;
      Track& track = *both[i]->track;
      track.filter = pair.likeliest()[i];
      track.hit(image_->camera, image_->pixels[spot] - both[i]->prediction.pixel(), nullptr, true);
    }
  }
}

/// A merged spot lies between its two LEDs, perhaps nearer to the brighter one. It moves both by
/// the same, and its noise covers any place between them.
void ImageUpdate::updateMerged(const Candidate& candidate, const Candidate& other) const {
  const bool is_own = candidate.spot.has_value();
  const std::size_t spot = is_own ? *candidate.spot : *other.spot;
  Track& track = *candidate.track;
  const Eigen::Vector2d between = candidate.prediction.pixel() - other.prediction.pixel();
  geometry::PixelNoise noise = noise_;
  noise.pixel_stddev =
      std::sqrt(noise_.pixel_stddev * noise_.pixel_stddev + between.squaredNorm() / 12.0 +
                0.5 * other.prediction.covariance().trace());
  const auto prediction = track.filter.predictPixel(camera_->forRays(), noise);
  const Eigen::Vector2d pixel = image_->pixels[spot] + 0.5 * between;
  if (!prediction || !(prediction->squaredDistance(pixel) <= options_.gate)) {
    track.miss(image_->camera, image_->time);
    return;
  }
  if (!track.filter.update(camera_->forRays(), *prediction, pixel))
    return;
  track.hit(image_->camera, pixel - prediction->pixel(), other.track, is_own);
}

}  // namespace wiimote_tracker::tracking
