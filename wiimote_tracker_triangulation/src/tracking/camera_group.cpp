#include "camera_group.h"

#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

// Memory, least and tolerated, chosen by simulated knocks such as those of test_tracker_knocks.cpp.
constexpr CameraFit::Limits kFitOfMany{40.0, 0.4, 0.7};

// Tracks of two cameras may follow wrong spots. So a misfit is found sooner (shorter memory) and
// ends only when nearly all LEDs fit. It takes a larger share, because LEDs that only one of both
// cameras sees look like misfits, too.
constexpr CameraFit::Limits kFitOfTwo{30.0, 0.55, 0.1};

constexpr double kLeastInterval = 1e-4;  // between exposures of one camera [s]

/// Standard deviation of each camera's turn about its optical axis [rad] or of its focal length, as
/// a share of it, the larger one; 0 without a covariance.
std::vector<double> turnStddevs(const geometry::Rig& rig) {
  std::vector<double> result(rig.cameras.size(), 0.0);
  if (!geometry::hasCovariance(rig))
    return result;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const geometry::Camera& camera = rig.cameras[i].camera;
    const Eigen::Index first = geometry::firstParameter(i);
    const Eigen::Index focal = first + geometry::kIntrinsics;
    const Eigen::Vector3d axis = camera.world_from_camera.linear().col(2);
    const Eigen::Matrix3d turn = rig.covariance.block<3, 3>(first, first);
    const double stretch = rig.covariance(focal, focal) / std::pow(camera.intrinsics.fx, 2);
    result[i] = std::sqrt(std::max({0.0, axis.dot(turn * axis), stretch}));
  }
  return result;
}

/// Whether there may be a crowd about a track's LED: more lights than the cameras of a group can
/// report. An LED that they do not report has no track, but it may be merged with one that has: the
/// spot is then between both, at most half of merging_distance from either. Residuals do not always
/// show that, nor does a third camera, which may face another one.
///
/// In a crowd a full camera shows an unknown light instead of the track's LED in its view, and
/// another one shows an unknown light or not the LED. What one camera alone shows may be a lamp, or
/// the camera was moved.
bool isInCrowd(const Track& track,
               const CameraStates& states,
               const std::vector<TrackerCamera>& cameras,
               const TrackerOptions& options,
               double time) {
  constexpr double kOldest = 0.2;  // more than between two images, if some are lost [s]
  const Eigen::Vector3d position = track.approximatePosition(time);
  std::size_t count = 0;
  bool is_crowded_out = false;
  for (const auto& [camera, state] : states) {
    const NewestImage& view = state.newest;
    if (!view.full || view.time < time - kOldest)
      continue;
    // No spot of it now, nor within tracked_time: a false detection hides an LED in one image only.
    const bool is_hidden =
        track.lastDetectedBy(camera) < std::min(view.time, time - options.tracked_time);
    if (!(is_hidden || view.has_unknown) || !cameras[camera].forRays().sees(position))
      continue;
    ++count;
    is_crowded_out = is_crowded_out || (is_hidden && view.has_unknown);
  }
  return count >= 2 && is_crowded_out;
}

}  // namespace

CameraGroup::CameraGroup(const geometry::Rig& rig,
                         const std::vector<std::size_t>& members,
                         const std::vector<std::vector<std::size_t>>& partners,
                         const std::vector<TrackerCamera>& cameras,
                         const TrackerOptions& options,
                         Ids* ids,
                         std::vector<CameraView>* views)
    : options_(options),
      ids_(ids),
      views_(views),
      members_(members),
      cameras_(cameras),
      clocks_(members) {
  const CameraFit fit(options_.ghost_rate, members_.size() > 2 ? kFitOfMany : kFitOfTwo);
  for (const std::size_t member : members_)
    state_.cameras.emplace(member, CameraState{fit, {}, {}, {}});
  useRig(rig, partners);
}

void CameraGroup::useRig(const geometry::Rig& rig,
                         const std::vector<std::vector<std::size_t>>& partners) {
  update_.emplace(rig, options_);
  initiation_.emplace(rig, partners, cameras_, options_, ids_);
  clocks_.setTurnStddevs(turnStddevs(rig));
  // The rays of unassigned spots are those of the former cameras.
  const auto forgetRays = [](GroupState* state) {
    for (auto& [camera, of_camera] : state->cameras)
      of_camera.unassigned = UnassignedSpots();
  };
  forgetRays(&state_);
  history_.changeStates(forgetRays);
}

bool CameraGroup::isDoubtful() const {
  return members_.size() == 2 && (isMisfit(members_[0]) || isMisfit(members_[1]));
}

CameraGroup::Outcome CameraGroup::add(const StoredImage& image) {
  const auto& images = history_.images();
  if (!images.empty() && image.time < images.back().time - options_.history)
    return Outcome::kDropped;
  auto place = history_.placeOf(image);
  if (!place)
    return Outcome::kDropped;
  if (*place > images.begin()) {
    const StoredImage& before = images.at(*place - 1);
    if (before.time == image.time && before.camera == image.camera)
      return Outcome::kRepeated;
  }
  const auto mistimed = mistimedBefore(*place, image);
  const bool is_late = mistimed || *place < images.end();
  const std::uint64_t first_changed = mistimed.value_or(*place);
  if (first_changed < next_step_)
    next_step_ = history_.rollBack(first_changed, &state_);
  if (mistimed) {
    history_.remove(*mistimed);
    --*place;
  }
  history_.insert(*place, image);
  if (is_late)
    return Outcome::kLate;
  update();
  history_.forgetBefore(images.back().time - options_.history);
  return Outcome::kAdded;
}

void CameraGroup::update() {
  for (; next_step_ < history_.images().end(); ++next_step_) {
    history_.keep(next_step_, state_);
    step(history_.images().at(next_step_));
  }
  if (state_.clocks == clocks_.version())
    clocks_.update(state_.cameras);
}

/// Finds an image of the same camera at nearly the same time. A busy computer delivers delayed
/// images in a burst with nearly equal stamps, of which only the last is right. The others would
/// make the LED appear to stop and jump.
std::optional<std::uint64_t> CameraGroup::mistimedBefore(std::uint64_t place,
                                                         const StoredImage& image) const {
  const auto& images = history_.images();
  for (std::uint64_t i = place; i > images.begin() && history_.canRepeatFrom(i - 1); --i) {
    const StoredImage& before = images.at(i - 1);
    if (before.time < image.time - kLeastInterval)
      break;
    if (before.camera == image.camera && before.arrival <= image.arrival)
      return i - 1;
  }
  return std::nullopt;
}

void CameraGroup::step(const StoredImage& image) {
  std::vector<Track>& tracks = state_.tracks;
  if (image.clocks != state_.clocks) {
    for (auto& [camera, state] : state_.cameras)
      state.clock_regression = ClockRegression();
    state_.clocks = image.clocks;
  }
  update_->apply(cameras_[image.camera], image, &state_);
  removeMergedPairs(image.time);
  // With two cameras, nobody would ever be confirmed in a crowd.
  const bool in_crowd = noteCrowd(image) && members_.size() > 2;
  show(image);
  collectUnassigned(image);
  initiation_->apply(image.camera, &state_);
  showStarts();
  for (Track& track : tracks) {
    const bool was_confirmed = track.isConfirmed();
    track.updateStatus(image.time, options_, in_crowd);
    if (track.isFinished() && track.isDuplicate())
      doubtPartnerOf(track.id);
    if (was_confirmed || !track.mayContinue())
      continue;
    if (Track* former = initiation_->formerTrackOf(track, &state_)) {
      former->continueAs(track);
      track.finish();
    }
  }
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [](const Track& track) { return track.isFinished(); }),
               tracks.end());
}

/// @returns whether unknown LEDs may be merged with some LED.
bool CameraGroup::noteCrowd(const StoredImage& image) {
  const auto begin = update_->trackOfSpot().begin();
  const bool has_unknown = std::any_of(begin, begin + image.spot_count, [&](int track) {
    return track == association::kFalseDetection || !state_.tracks[track].isConfirmed();
  });
  state_.cameras.at(image.camera).newest = {image.time, image.full, has_unknown};
  bool in_crowd = false;
  for (Track& track : state_.tracks) {
    if (!track.isConfirmed())
      continue;
    if (isInCrowd(track, state_.cameras, cameras_, options_, image.time))
      track.noteCrowd(image.time);
    in_crowd = in_crowd || track.isCrowded(image.time);
  }
  return in_crowd;
}

Eigen::Matrix3d CameraGroup::mergingCovariance(const Track& track,
                                               const TrackedLed& led,
                                               double time) const {
  constexpr double kSingular = 1e-10;
  if (!track.isCrowded(time))
    return Eigen::Matrix3d::Zero();
  const double stddev = 0.25 * options_.merging_distance;  // of a coordinate in the circle [px]
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const std::size_t camera : led.cameras) {
    Eigen::Matrix<double, 2, 3> jacobian;
    if (cameras_[camera].forRays().project(led.position, &jacobian))
      information.noalias() += jacobian.transpose() * jacobian;
  }
  const double trace = information.trace();
  if (!(information.determinant() > kSingular * trace * trace * trace))  // one camera, or none
    return Eigen::Matrix3d::Zero();
  return stddev * stddev * information.inverse();
}

/// Removes pairs that are decided, and those whose tracks ended or were reacquired since.
void CameraGroup::removeMergedPairs(double time) {
  std::vector<MergedPair>& pairs = state_.pairs;
  for (auto pair = pairs.begin(); pair != pairs.end();) {
    Track* const first = continuing(pair->ids()[0], pair->openedAt());
    Track* const second = continuing(pair->ids()[1], pair->openedAt());
    if (first && second && !pair->isDecided(time, options_.doubt_time)) {
      ++pair;
      continue;
    }
    if (first && second) {
      first->noteMeeting(pair->probability());
      second->noteMeeting(pair->probability());
    }
    pair = pairs.erase(pair);
  }
}

/// Nothing tells which LED of a merged pair the other track follows, once one of both has ended.
void CameraGroup::doubtPartnerOf(std::uint32_t ended) {
  for (const MergedPair& pair : state_.pairs) {
    if (!pair.has(ended))
      continue;
    const std::uint32_t partner = pair.ids()[0] == ended ? pair.ids()[1] : pair.ids()[0];
    if (Track* track = continuing(partner, pair.openedAt()))
      track->noteMeeting(0.5);
  }
}

/// The track of that id, unless it was reacquired later than this [s].
Track* CameraGroup::continuing(std::uint32_t id, double since) {
  const auto track = std::find_if(
      state_.tracks.begin(), state_.tracks.end(),
      [&](const Track& candidate) { return candidate.id == id && candidate.startedAt() <= since; });
  return track == state_.tracks.end() ? nullptr : &*track;
}

/// None of an image that does not fit, unless there are only two cameras.
void CameraGroup::collectUnassigned(const StoredImage& image) {
  UnassignedSpots& rest = state_.cameras.at(image.camera).unassigned;
  if (rest.spots.empty())
    rest.since = image.time;
  rest.time = image.time;
  rest.stamp_stddev = image.stamp_stddev;
  rest.full = image.full;
  rest.spots.clear();
  rest.sights.clear();
  if (isMisfit(image.camera) && members_.size() > 2)
    return;
  for (std::size_t spot = 0; spot < image.spot_count; ++spot) {
    if (update_->trackOfSpot()[spot] != association::kFalseDetection)
      continue;
    const Eigen::Vector2d& pixel = image.pixels[spot];
    if (const auto sight = geometry::sightFromPixel(cameras_[image.camera].forRays(), pixel)) {
      rest.spots.push_back({pixel, {image.number, spot}});
      rest.sights.push_back(*sight);
    }
  }
}

void CameraGroup::show(const StoredImage& image) const {
  CameraView& view = (*views_)[image.camera];
  view.time = image.time;
  view.stamp_stddev = image.stamp_stddev;
  view.full = image.full;
  view.spots.resize(image.pixels.size());
  for (std::size_t spot = 0; spot < image.pixels.size(); ++spot) {
    SeenSpot& seen = view.spots[spot];
    seen = SeenSpot();
    seen.pixel = image.pixels[spot];
    if (spot >= image.spot_count) {
      seen.use = SpotUse::kMasked;
    } else if (update_->trackOfSpot()[spot] != association::kFalseDetection) {
      seen.use = SpotUse::kAssigned;
      seen.led = state_.tracks[update_->trackOfSpot()[spot]].id;
    }
  }
}

/// Writes which spots began a track, also in the views of older images. A view of a newer image is
/// left alone: the steps are being repeated, and its own one follows.
void CameraGroup::showStarts() const {
  for (const StartSpot& start : initiation_->starts()) {
    CameraView& view = (*views_)[start.camera];
    if (view.time != state_.cameras.at(start.camera).unassigned.time)
      continue;
    view.spots[start.spot].use = SpotUse::kStart;
    view.spots[start.spot].led = start.led;
  }
}

void CameraGroup::adopt(const Track& track) {
  state_.tracks.push_back(track);
  state_.tracks.back().forgetCameras();
  std::sort(state_.tracks.begin(), state_.tracks.end(),
            [](auto& a, auto& b) { return a.id < b.id; });
}

void CameraGroup::clear() {
  history_.clear();
  next_step_ = 0;
  state_.tracks.clear();
  state_.pairs.clear();
  for (auto& [camera, state] : state_.cameras) {
    state.unassigned = UnassignedSpots();
    state.newest = NewestImage();
  }
}

}  // namespace wiimote_tracker::tracking
