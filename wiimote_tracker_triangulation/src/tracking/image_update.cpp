#include "image_update.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker::tracking {

ImageUpdate::ImageUpdate(const TrackerOptions& options)
    : options_(options), steps_(options.motion) {}

void ImageUpdate::apply(const GroupCamera& camera,
                        const StoredImage& image,
                        std::vector<Track>* tracks,
                        std::vector<Encounter>* encounters) {
  noise_.pixel_stddev = options_.pixel_stddev;
  noise_.stamp_stddev = image.stamp_stddev;
  collectCandidates(camera, image, tracks);
  assign(image, *tracks);
  followEncounters(camera, image, tracks, encounters);
  findMergedSpots(image, *tracks);
  openEncounters(*tracks, encounters);
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    const Candidate& candidate = candidates_[i];
    Track& track = (*tracks)[candidate.track];
    if (candidate.updated)
      continue;
    const Candidate* other = sharing(candidate, *tracks);
    if (other && track.isConfirmed() && isSeenBeside(image, track))
      updateMerged(camera, image, candidate, *other, tracks);
    else if (other && track.isConfirmed())
      track.miss(image.camera, image.time);  // the spot is the other's
    else if (candidate.spot != kNone)
      updateTrack(camera, image, candidate, other ? &(*tracks)[other->track] : nullptr, &track);
    else if (candidate.expected)
      track.miss(image.camera, image.time);
  }
}

void ImageUpdate::collectCandidates(const GroupCamera& camera,
                                    const StoredImage& image,
                                    std::vector<Track>* tracks) {
  candidate_count_ = 0;
  for (std::size_t i = 0; i < tracks->size(); ++i) {
    Track& track = (*tracks)[i];
    if (candidate_count_ == candidates_.size())
      return;
    if (!camera.mayShow(track.roughPlace(image.time)))
      continue;
    track.filter.predict(image.time, &steps_);
    const auto prediction = track.filter.predictPixel(camera.forRays(), noise_);
    if (!prediction || !camera.isInImage(prediction->pixel(), options_.merging_distance) ||
        isVague(track, *prediction, image.time))
      continue;
    Candidate& candidate = candidates_[candidate_count_++];
    candidate.track = i;
    candidate.prediction = *prediction;
    candidate.expected = !image.full && camera.isInImage(prediction->pixel(), 0.0) &&
                         !camera.isMasked(prediction->pixel());
    candidate.spot = kNone;
    candidate.updated = false;
  }
}

/// What was not seen for a while may be anywhere within so wide a region that a single spot there
/// does not show it: two cameras must (see Births). What blinks is not missed while it may be dark.
bool ImageUpdate::isVague(const Track& track,
                          const motion::PixelPrediction& prediction,
                          double time) const {
  const double sharp = 2.0 * options_.birth_pixel_stddev;
  return time - track.lastObserved() > options_.birth_window + options_.dark_time &&
         prediction.covariance().trace() > 2.0 * sharp * sharp;
}

/// Whether it is not this camera alone that shows it.
bool ImageUpdate::isSeenBeside(const StoredImage& image, const Track& track) const {
  return track.isSeenBeside(image.camera, image.time - options_.birth_window);
}

/// Costs are negative log likelihoods; a spot's density is that of its prediction, or uniform over
/// the image for what is no LED's.
void ImageUpdate::assign(const StoredImage& image, const std::vector<Track>& tracks) {
  constexpr double kImageArea = 1024.0 * 768.0;  // of a Wii Remote [px^2]; others are near enough
  constexpr double kDoubtCost = 3.0;             // what may be an LED there yields to what is
  const double detected = -std::log(options_.detection_probability);
  const double missed = -std::log(1.0 - options_.detection_probability);
  costs_.reset(image.spot_count, candidate_count_, -std::log(options_.ghost_rate / kImageArea),
               missed);
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    const Candidate& candidate = candidates_[i];
    if (!candidate.expected)
      costs_.miss[i] = detected;
    const Track& track = tracks[candidate.track];
    const bool is_sure = track.isConfirmed() && isSeenBeside(image, track);
    const double extra = detected + (is_sure ? 0.0 : kDoubtCost);
    for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
      if (const auto likelihood =
              candidate.prediction.logLikelihoodWithin(options_.gate, image.pixels[spot]))
        costs_.pair[spot][i] = extra - *likelihood;
    }
  }
  const association::SpotAssignment best = association::assignSpots(costs_);
  track_of_spot_.fill(association::kGhost);
  for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
    if (best.track_of_spot[spot] == association::kGhost)
      continue;
    give(spot, &candidates_[static_cast<std::size_t>(best.track_of_spot[spot])]);
  }
}

void ImageUpdate::updateTrack(const GroupCamera& camera,
                              const StoredImage& image,
                              const Candidate& candidate,
                              const Track* other,
                              Track* track) const {
  const Eigen::Vector2d& pixel = image.pixels[static_cast<std::size_t>(candidate.spot)];
  if (!track->filter.update(camera.forRays(), candidate.prediction, pixel))
    return;
  track->hit(image.camera, pixel - candidate.prediction.pixel(), true);
  if (other)
    track->noteShared(other->id, true);
  else
    track->noteAlone();
}

/// The other LED whose light may have fallen into the same spot: one of the two has a spot, the
/// other none, and they are expected so close together that the camera can not tell them apart.
const ImageUpdate::Candidate* ImageUpdate::sharing(const Candidate& candidate,
                                                   const std::vector<Track>& tracks) const {
  const Candidate* nearest = nullptr;
  double least = options_.merging_distance;
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    const Candidate& other = candidates_[i];
    if (other.track == candidate.track || (other.spot == kNone) == (candidate.spot == kNone) ||
        !tracks[other.track].isConfirmed())
      continue;
    const double distance = (other.prediction.pixel() - candidate.prediction.pixel()).norm();
    if (distance < least) {
      least = distance;
      nearest = &other;
    }
  }
  return nearest;
}

/// A spot between two LEDs that are expected so close together that the camera can not tell them
/// apart, and that both have none, is of both: from each alone it may be too far.
void ImageUpdate::findMergedSpots(const StoredImage& image, const std::vector<Track>& tracks) {
  const auto isAlone = [&](const Candidate& candidate) {
    return candidate.spot == kNone && tracks[candidate.track].isConfirmed();
  };
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    for (std::size_t j = i + 1; j < candidate_count_; ++j) {
      Candidate& a = candidates_[i];
      Candidate& b = candidates_[j];
      if (!isAlone(a) || !isAlone(b))
        continue;
      const Eigen::Vector2d between = b.prediction.pixel() - a.prediction.pixel();
      if (between.norm() >= options_.merging_distance)
        continue;
      const Eigen::Vector2d middle = a.prediction.pixel() + 0.5 * between;
      std::optional<std::size_t> nearest;
      double least = 0.5 * options_.merging_distance;
      for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
        const double distance = (image.pixels[spot] - middle).norm();
        if (track_of_spot_[spot] == association::kGhost && distance < least) {
          least = distance;
          nearest = spot;
        }
      }
      if (nearest)
        give(*nearest, (image.pixels[*nearest] - middle).dot(between) > 0.0 ? &b : &a);
    }
  }
}

void ImageUpdate::openEncounters(const std::vector<Track>& tracks,
                                 std::vector<Encounter>* encounters) const {
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    const Candidate& candidate = candidates_[i];
    const Candidate* other = candidate.spot == kNone ? nullptr : sharing(candidate, tracks);
    if (!other || !tracks[candidate.track].isConfirmed())
      continue;
    const Track& a = tracks[candidate.track];
    const Track& b = tracks[other->track];
    const bool is_open =
        std::any_of(encounters->begin(), encounters->end(), [&](const Encounter& encounter) {
          const auto& ids = encounter.ids();
          return std::count(ids.begin(), ids.end(), a.id) ||
                 std::count(ids.begin(), ids.end(), b.id);
        });
    if (!is_open)
      encounters->emplace_back(a.id, b.id, Encounter::Filters{a.filter, b.filter});
  }
}

/// In an image that shows both, an encounter says which spots are theirs; else the image is taken
/// in as any other.
void ImageUpdate::followEncounters(const GroupCamera& camera,
                                   const StoredImage& image,
                                   std::vector<Track>* tracks,
                                   std::vector<Encounter>* encounters) {
  for (Encounter& encounter : *encounters) {
    const std::array<Candidate*, 2> both = {find(*tracks, encounter.ids()[0]),
                                            find(*tracks, encounter.ids()[1])};
    if (!both[0] || !both[1])
      continue;
    Encounter::View view;
    view.camera = &camera.forRays();
    view.noise = noise_;
    view.time = image.time;
    std::array<std::size_t, association::kMaximumSpots> spot_of;  // of the view
    for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
      const int owner = track_of_spot_[spot];
      if (owner != association::kGhost && owner != static_cast<int>(both[0]->track) &&
          owner != static_cast<int>(both[1]->track))
        continue;
      spot_of[view.spot_count] = spot;
      view.pixels[view.spot_count++] = image.pixels[spot];
    }
    const auto places = encounter.take(view, options_.gate, &steps_);
    if (!places)
      continue;
    for (std::size_t i = 0; i < view.spot_count; ++i)
      track_of_spot_[spot_of[i]] = association::kGhost;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t spot = spot_of[(*places)[i]];
      give(spot, both[i]);
      both[i]->updated = true;
      Track& track = (*tracks)[both[i]->track];
      track.filter = encounter.likeliest()[i];
      track.hit(image.camera, image.pixels[spot] - both[i]->prediction.pixel(), true);
      track.noteAlone();
    }
  }
}

void ImageUpdate::give(std::size_t spot, Candidate* candidate) {
  candidate->spot = static_cast<int>(spot);
  track_of_spot_[spot] = static_cast<int>(candidate->track);
}

ImageUpdate::Candidate* ImageUpdate::find(const std::vector<Track>& tracks, std::uint32_t id) {
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    if (tracks[candidates_[i].track].id == id)
      return &candidates_[i];
  }
  return nullptr;
}

/// One spot of two LEDs lies between them, perhaps nearer to the brighter one. It moves both by the
/// same, so that they keep their distance, and says no more than that about either.
void ImageUpdate::updateMerged(const GroupCamera& camera,
                               const StoredImage& image,
                               const Candidate& candidate,
                               const Candidate& other,
                               std::vector<Track>* tracks) const {
  const bool is_own = candidate.spot != kNone;
  const auto spot = static_cast<std::size_t>(is_own ? candidate.spot : other.spot);
  Track& track = (*tracks)[candidate.track];
  const Eigen::Vector2d between = candidate.prediction.pixel() - other.prediction.pixel();
  motion::PixelNoise noise = noise_;
  noise.pixel_stddev =
      std::sqrt(noise_.pixel_stddev * noise_.pixel_stddev + between.squaredNorm() / 12.0 +
                0.5 * other.prediction.covariance().trace());
  const auto prediction = track.filter.predictPixel(camera.forRays(), noise);
  const Eigen::Vector2d pixel = image.pixels[spot] + 0.5 * between;
  if (!prediction || !(prediction->squaredDistance(pixel) <= options_.gate)) {
    track.miss(image.camera, image.time);
    return;
  }
  if (!track.filter.update(camera.forRays(), *prediction, pixel))
    return;
  track.hit(image.camera, pixel - prediction->pixel(), is_own);
  track.noteShared((*tracks)[other.track].id, is_own);
}

}  // namespace wiimote_tracker::tracking
