#include "merged_spots.h"

#include <Eigen/LU>
#include <boost/container/static_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace wiimote_tracker::tracking {
namespace {

/// Probability [0..1] that the spot of one LED is that of two merged LEDs, rather than of this one
/// while the other, which has none, is hidden. A merged spot is between both predictions, a single
/// one at its own. The distance below which two LEDs merge is uniform up to merging_distance, as
/// far as we know.
double mergedProbability(const ImageAssignment& assignment,
                         const Candidate& visible,
                         const Candidate& absent) {
  constexpr double kSpread = 0.15;  // of the place between two LEDs, by their brightness [1]
  const TrackerOptions& options = assignment.options;
  const Eigen::Vector2d& spot = assignment.image.pixels[*visible.spot];
  const double pixel_stddev = assignment.noise.pixel_stddev;
  // An LED that was hidden from this camera mostly stays hidden.
  const double hidden = absent.track->cameras().wasMissedBy(assignment.image.camera)
                            ? options.detection_probability
                            : 1.0 - options.detection_probability;
  const Eigen::Vector2d between = absent.pixel() - visible.pixel();
  const double merging = 1.0 - between.norm() / options.merging_distance;  // prior probability
  if (merging <= 0.0)
    return 0.0;
  const Eigen::Vector2d residual = spot - visible.pixel() - 0.5 * between;
  // Of the spot about the middle. Half of the pixel noise comes with the two predictions.
  const Eigen::Matrix2d covariance =
      0.25 * (visible.prediction.covariance() + absent.prediction.covariance()) +
      0.5 * pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity() +
      kSpread * kSpread * between * between.transpose();
  const double merged = -0.5 * residual.dot(covariance.inverse() * residual) -
                        std::log(2.0 * M_PI * std::sqrt(covariance.determinant()));
  const double log_odds =
      merged - visible.prediction.logLikelihood(spot) + std::log((1.0 - hidden) * merging / hidden);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

bool areClose(const Candidate& a, const Candidate& b, const TrackerOptions& options) {
  return (a.pixel() - b.pixel()).norm() < options.merging_distance;
}

/// An unassigned spot between two LEDs that have none is the merged spot of both, if they are close
/// enough. It may be outside the gates of both.
std::optional<std::size_t> spotBetween(const ImageAssignment& assignment,
                                       const Candidate& a,
                                       const Candidate& b) {
  if (!areClose(a, b, assignment.options))
    return std::nullopt;
  return assignment.nearestUnassigned(0.5 * (a.pixel() + b.pixel()),
                                      0.5 * assignment.options.merging_distance);
}

/// Whether one spot may show two LEDs that have none: it lies on the line between them, nearer than
/// merging_distance to each. Bright spots merge over more.
bool mayShowBoth(const ImageAssignment& assignment,
                 std::size_t spot,
                 const Candidate& a,
                 const Candidate& b) {
  const TrackerOptions& options = assignment.options;
  const Eigen::Vector2d from_a = assignment.image.pixels[spot] - a.pixel();
  const Eigen::Vector2d between = b.pixel() - a.pixel();
  if (a.spot || b.spot || from_a.norm() >= options.merging_distance ||
      (from_a - between).norm() >= options.merging_distance)
    return false;
  const double squared = between.squaredNorm();
  const double share = squared > 0.0 ? std::clamp(from_a.dot(between) / squared, 0.0, 1.0) : 0.0;
  return (from_a - share * between).norm() <= options.birth_pixel_stddev;
}

/// The track of that id, unless it was reacquired later than this [s].
Track* trackSince(double since, std::uint32_t id, std::vector<Track>* tracks) {
  const auto track = std::find_if(tracks->begin(), tracks->end(), [&](const Track& candidate) {
    return candidate.id() == id && candidate.startedAt() <= since;
  });
  return track == tracks->end() ? nullptr : &*track;
}

}  // namespace

bool mayBeMerged(const ImageAssignment& assignment, const Candidate& candidate) {
  const auto& all = assignment.candidates;
  return std::any_of(all.begin(), all.end(), [&](const Candidate& other) {
    return other.track != candidate.track && areClose(candidate, other, assignment.options) &&
           (other.spot ||
            (other.track->isConfirmed() && spotBetween(assignment, candidate, other)));
  });
}

const Candidate* shownByItsSpot(const ImageAssignment& assignment, const Candidate& candidate) {
  const auto& all = assignment.candidates;
  // Radio may lose all images of a camera for a while.
  const double since = assignment.image.time -
                       std::max(assignment.options.tracked_time, assignment.options.birth_window);
  const auto isOther = [&](const Candidate& led) {
    return led.track != candidate.track && led.expected &&
           led.track->cameras().detecting(since, assignment.image.camera).size() >= 2;
  };
  for (auto a = all.begin(); a != all.end(); ++a) {
    for (auto b = a + 1; b != all.end(); ++b) {
      if (mayShowBoth(assignment, *candidate.spot, *a, *b) && isOther(*a) && isOther(*b))
        return &*a;
    }
  }
  return nullptr;
}

const Candidate* mergedWith(const ImageAssignment& assignment, const Candidate& candidate) {
  const Candidate* result = nullptr;
  double greatest = 0.5;
  for (const Candidate& other : assignment.candidates) {
    if (other.track == candidate.track || other.spot.has_value() == candidate.spot.has_value() ||
        !other.track->isConfirmed())
      continue;
    const double probability = other.spot ? mergedProbability(assignment, other, candidate)
                                          : mergedProbability(assignment, candidate, other);
    if (probability > greatest) {
      greatest = probability;
      result = &other;
    }
  }
  return result;
}

/// A merged spot lies between its two LEDs, perhaps nearer to the brighter one. It moves both by
/// the same, and its noise covers any place between them.
void updateMerged(const ImageAssignment& assignment,
                  const Candidate& candidate,
                  const Candidate& other) {
  const StoredImage& image = assignment.image;
  const geometry::Camera& camera = assignment.camera.forRays();
  const bool is_own = candidate.spot.has_value();
  const std::size_t spot = is_own ? *candidate.spot : *other.spot;
  Track& track = *candidate.track;
  const Eigen::Vector2d between = candidate.pixel() - other.pixel();
  geometry::PixelNoise noise = assignment.noise;
  noise.pixel_stddev =
      std::sqrt(noise.pixel_stddev * noise.pixel_stddev + between.squaredNorm() / 12.0 +
                0.5 * other.prediction.covariance().trace());
  const auto prediction = track.filter().predictPixel(camera, noise);
  const Eigen::Vector2d pixel = image.pixels[spot] + 0.5 * between;
  if (!prediction || !(prediction->squaredDistance(pixel) <= assignment.options.gate))
    track.miss(image.camera, image.time);
  else if (track.update(camera, *prediction, pixel))
    track.hit(image.camera, pixel - prediction->pixel(), other.track, is_own);
}

void assignMergedSpots(ImageAssignment* assignment) {
  const auto isAlone = [](const Candidate& candidate) {
    return !candidate.spot && candidate.track->isConfirmed();
  };
  auto& candidates = assignment->candidates;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (std::size_t j = i + 1; j < candidates.size(); ++j) {
      Candidate &a = candidates[i], &b = candidates[j];
      const auto spot = isAlone(a) && isAlone(b) ? spotBetween(*assignment, a, b) : std::nullopt;
      if (!spot)
        continue;
      const Eigen::Vector2d between = b.pixel() - a.pixel();
      const Eigen::Vector2d from_a = assignment->image.pixels[*spot] - a.pixel();
      (from_a.dot(between) > 0.5 * between.squaredNorm() ? b : a).spot = spot;
    }
  }
}

void openMergedPairs(const ImageAssignment& assignment, std::vector<MergedPair>* pairs) {
  const double since = assignment.image.time - assignment.options.birth_window;
  for (const Candidate& candidate : assignment.candidates) {
    const Candidate* other = candidate.spot ? mergedWith(assignment, candidate) : nullptr;
    if (!other || !candidate.track->isConfirmed())
      continue;
    const Track& a = *candidate.track;
    const Track& b = *other->track;
    const bool is_known = std::any_of(pairs->begin(), pairs->end(), [&](const MergedPair& pair) {
      return pair.has(a.id()) || pair.has(b.id());
    });
    if (!is_known && !a.cameras().showBeside(b.cameras(), since))
      pairs->emplace_back(a.id(), b.id(), MergedPair::Filters{a.filter(), b.filter()});
  }
}

void updateMergedPairs(std::vector<MergedPair>* pairs, ImageAssignment* assignment) {
  const StoredImage& image = assignment->image;
  for (MergedPair& pair : *pairs) {
    const std::array<Candidate*, 2> both = {assignment->find(pair.ids()[0]),
                                            assignment->find(pair.ids()[1])};
    if (!both[0] || !both[1])
      continue;
    MergedPair::View view{&assignment->camera.forRays(), assignment->noise, image.time, {}};
    boost::container::static_vector<std::size_t, association::kMaximumSpots> spot_of;  // the view's
    for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
      if (!assignment->isUnassigned(spot) && both[0]->spot != spot && both[1]->spot != spot)
        continue;
      spot_of.push_back(spot);
      view.pixels.push_back(image.pixels[spot]);
    }
    const auto chosen = pair.update(view, assignment->options.gate);
    if (!chosen)
      continue;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t spot = spot_of[(*chosen)[i]];
      both[i]->spot = spot;
      both[i]->updated = true;
      Track& track = *both[i]->track;
      track.useFilter(pair.likeliest()[i]);
      track.hit(image.camera, image.pixels[spot] - both[i]->pixel(), nullptr, true);
    }
  }
}

void closeMergedPairs(double time, double doubt_time, GroupState* state) {
  const auto isClosed = [&](const MergedPair& pair) {
    Track* const first = trackSince(pair.openedAt(), pair.ids()[0], &state->tracks);
    Track* const second = trackSince(pair.openedAt(), pair.ids()[1], &state->tracks);
    if (!first || !second)
      return true;
    if (!pair.isDecided(time, doubt_time))
      return false;
    first->noteMeeting(pair.probability());
    second->noteMeeting(pair.probability());
    return true;
  };
  std::vector<MergedPair>& pairs = state->pairs;
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), isClosed), pairs.end());
}

void doubtPartnerOf(std::uint32_t ended, GroupState* state) {
  for (const MergedPair& pair : state->pairs) {
    if (!pair.has(ended))
      continue;
    const std::uint32_t partner = pair.ids()[0] == ended ? pair.ids()[1] : pair.ids()[0];
    if (Track* track = trackSince(pair.openedAt(), partner, &state->tracks))
      track->noteMeeting(0.5);
  }
}

}  // namespace wiimote_tracker::tracking
