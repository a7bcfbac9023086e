#include "camera_group.h"

#include "image_update.h"
#include "merged_spots.h"
#include "reacquisition.h"
#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"

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

}  // namespace

CameraGroup::CameraGroup(const GroupSetup& setup,
                         const std::vector<std::size_t>& members,
                         const std::vector<std::vector<std::size_t>>& partners,
                         Ids* ids,
                         std::vector<CameraView>* views)
    : setup_(setup),
      ids_(ids),
      views_(views),
      members_(members),
      clocks_(members),
      history_(&state_, setup.options.history) {
  const CameraFit fit(setup_.options.ghost_rate, members_.size() > 2 ? kFitOfMany : kFitOfTwo);
  for (const std::size_t member : members_)
    state_.cameras.emplace(member, CameraState{fit, {}, {}, {}});
  useRig(partners);
}

void CameraGroup::useRig(const std::vector<std::vector<std::size_t>>& partners) {
  initiation_.emplace(setup_, partners, ids_);
  clocks_.setTurnStddevs(turnStddevs(setup_.rig));
  // The rays of unassigned spots are those of the former cameras.
  const auto forgetRays = [](GroupState* state) {
    for (auto& [camera, of_camera] : state->cameras)
      of_camera.unassigned = UnassignedSpots();
  };
  forgetRays(&state_);
  history_.changeStates(forgetRays);
}

bool CameraGroup::isMisfitPair() const {
  return members_.size() == 2 && (isMisfit(members_[0]) || isMisfit(members_[1]));
}

Outcome CameraGroup::add(const StoredImage& image) {
  const Outcome outcome = history_.add(image);
  if (outcome == Outcome::kAdded)
    update();
  return outcome;
}

void CameraGroup::update() {
  history_.catchUp([this](const StoredImage& image) { step(image); });
  if (state_.clocks == clocks_.version())
    clocks_.update(state_.cameras);
}

void CameraGroup::step(const StoredImage& image) {
  if (image.clocks != state_.clocks) {
    for (auto& [camera, state] : state_.cameras)
      state.offset_regression = OffsetRegression();
    state_.clocks = image.clocks;
  }
  const association::TrackOfSpot track_of_spot = updateTracks(setup_, image, &state_);
  closeMergedPairs(image.time, setup_.options.doubt_time, &state_);
  // With two cameras, nobody would ever be confirmed in a crowd.
  const bool in_crowd = noteCrowds(image, track_of_spot, setup_, &state_) && members_.size() > 2;
  show(image, track_of_spot);
  collectUnassigned(image, track_of_spot);
  showStarts(initiation_->apply(image.camera, &state_));
  updateStatuses(image.time, in_crowd);
}

void CameraGroup::updateStatuses(double time, bool in_crowd) {
  std::vector<Track>& tracks = state_.tracks;
  for (Track& track : tracks) {
    const bool was_confirmed = track.isConfirmed();
    track.updateStatus(time, setup_.options, in_crowd);
    if (track.isFinished() && track.isDuplicate())
      doubtPartnerOf(track.id(), &state_);
    if (was_confirmed || !track.mayReacquire())
      continue;
    if (Track* reacquired = reacquiredBy(track, setup_.options, &state_)) {
      reacquired->continueAs(track);
      track.finish();
    }
  }
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [](const Track& track) { return track.isFinished(); }),
               tracks.end());
}

/// None of an image that does not fit, unless there are only two cameras.
void CameraGroup::collectUnassigned(const StoredImage& image,
                                    const association::TrackOfSpot& track_of_spot) {
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
    if (track_of_spot[spot] != association::kFalseDetection)
      continue;
    const Eigen::Vector2d& pixel = image.pixels[spot];
    if (const auto sight =
            geometry::sightFromPixel(setup_.cameras[image.camera].forRays(), pixel)) {
      rest.spots.push_back({pixel, {image.number, spot}});
      rest.sights.push_back(*sight);
    }
  }
}

void CameraGroup::show(const StoredImage& image,
                       const association::TrackOfSpot& track_of_spot) const {
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
    } else if (track_of_spot[spot] != association::kFalseDetection) {
      seen.use = SpotUse::kAssigned;
      seen.led = state_.tracks[track_of_spot[spot]].id();
    }
  }
}

/// Writes which spots began a track, also in the views of older images. A view of a newer image is
/// left alone: the steps are being repeated, and its own one follows.
void CameraGroup::showStarts(const std::vector<StartSpot>& starts) const {
  for (const StartSpot& start : starts) {
    CameraView& view = (*views_)[start.camera];
    if (view.time != state_.cameras.at(start.camera).unassigned.time)
      continue;
    view.spots[start.spot].use = SpotUse::kStart;
    view.spots[start.spot].led = start.led;
  }
}

void CameraGroup::adopt(const Track& track) {
  state_.tracks.push_back(track);
  state_.tracks.back().cameras().clear();
  std::sort(state_.tracks.begin(), state_.tracks.end(),
            [](auto& a, auto& b) { return a.id() < b.id(); });
}

void CameraGroup::clear() {
  history_.clear();
  state_.tracks.clear();
  state_.pairs.clear();
  for (auto& [camera, state] : state_.cameras) {
    state.unassigned = UnassignedSpots();
    state.newest = NewestImage();
  }
}

}  // namespace wiimote_tracker::tracking
