#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include "camera_group.h"
#include "crowd.h"
#include "ids.h"
#include "tracking/image_intake.h"
#include "wiimote_tracker_triangulation/geometry/shared_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

bool hasSmallerId(const TrackedLed& a, const TrackedLed& b) {
  return a.id < b.id;
}

}  // namespace

Tracker::Tracker(const geometry::Rig& rig, const TrackerOptions& options)
    : options_(options),
      intake_(std::make_unique<ImageIntake>(options.stamp_stddev)),
      ids_(std::make_unique<Ids>()),
      newest_time_(kNever),
      newest_arrival_(kNever),
      last_output_(kNever) {
  rig.check();
  useRig(rig, geometry::sharedViews(rig, options_.maximum_range));
}

Tracker::~Tracker() = default;

void Tracker::setRig(const geometry::Rig& rig) {
  rig.check();
  const Partners partners = geometry::sharedViews(rig, options_.maximum_range);
  if (hasSameGroups(rig, partners)) {
    useCameras(rig);
    for (const auto& group : groups_)
      group->useRig(partners);
    return;
  }
  updateGroups();
  const auto before = std::exchange(groups_, {});
  useRig(rig, partners);
  takeOverTracks(before);
}

/// Whether a rig has the same cameras at the same places, with the same clocks in the same groups.
bool Tracker::hasSameGroups(const geometry::Rig& rig, const Partners& partners) const {
  const auto groups = geometry::groupsOf(partners);
  return std::equal(rig.cameras.begin(), rig.cameras.end(), rig_.cameras.begin(),
                    rig_.cameras.end(), geometry::isSameCamera) &&
         std::equal(
             groups.begin(), groups.end(), groups_.begin(), groups_.end(),
             [](const auto& members, const auto& group) { return members == group->members(); });
}

void Tracker::useCameras(const geometry::Rig& rig) {
  rig_ = rig;
  intake_->setRig(rig);
  uncertainty_.emplace(rig_);
  cameras_.clear();
  for (const geometry::RigCamera& camera : rig_.cameras)
    cameras_.emplace_back(rig_, camera, options_);
}

void Tracker::useRig(const geometry::Rig& rig, const Partners& partners) {
  useCameras(rig);
  groups_.clear();
  inputs_.resize(cameras_.size());
  for (const std::vector<std::size_t>& members : geometry::groupsOf(partners)) {
    groups_.push_back(std::make_unique<CameraGroup>(GroupSetup{rig_, cameras_, options_}, members,
                                                    partners, ids_.get(), &views_));
    for (const std::size_t member : members)
      inputs_[member] = Input{groups_.back().get()};
  }
  views_.assign(rig_.cameras.size(), CameraView());
}

/// Moves each track to the group with the most cameras that may see it.
void Tracker::takeOverTracks(const std::vector<std::unique_ptr<CameraGroup>>& before) {
  for (const auto& old_group : before) {
    for (const Track& track : old_group->tracks()) {
      const Eigen::Vector3d position = track.filter().position();
      const auto viewers = [&](const std::unique_ptr<CameraGroup>& group) {
        return std::count_if(
            group->members().begin(), group->members().end(),
            [&](std::size_t member) { return cameras_[member].mayShow(position); });
      };
      const auto best = std::max_element(groups_.begin(), groups_.end(),
                                         [&](auto& a, auto& b) { return viewers(a) < viewers(b); });
      if (viewers(*best) > 0)
        (*best)->adopt(track);
    }
  }
}

void Tracker::add(std::size_t camera, const CameraImage& image) {
  StoredImage stored;
  const ImageIntake::Result result =
      intake_->take(camera, image, clockError(camera, image.clock_epoch), &stored);
  counters_.disordered += intake_->isDisordered();
  if (result == ImageIntake::Result::kWrongClock) {
    ++counters_.dropped;
    return;
  }
  if (result == ImageIntake::Result::kJumpedBack)
    reset();
  complete(image, &stored);
  Input& input = inputs_[camera];
  switch (input.group->add(stored)) {
    case Outcome::kRepeated:
      ++counters_.repeated;
      return;
    case Outcome::kDropped:
      ++counters_.dropped;
      ++input.dropped_in_a_row;
      input.lateness = newest_time_ - stored.time;
      return;
    case Outcome::kLate:
      ++counters_.late;
      break;
    case Outcome::kAdded:
      break;
  }
  input.dropped_in_a_row = 0;
  newest_time_ = std::max(newest_time_, stored.time);
  newest_arrival_ = std::max(newest_arrival_, image.arrival);
  ids_->forgetBefore(newest_time_ - 2.0 * options_.history);
}

/// Time jumped back: the images and tracks so far are of another time.
void Tracker::reset() {
  ++counters_.resets;
  for (const auto& group : groups_)
    group->clear();
  views_.assign(views_.size(), CameraView());
  newest_time_ = newest_arrival_ = last_output_ = kNever;
}

/// Adds to an image's time all else, with the usable spots first, then the masked ones. Spots
/// outside the image are left out.
void Tracker::complete(const CameraImage& image, StoredImage* stored) {
  const std::size_t camera = stored->camera;
  ClockOffsets& clocks = inputs_[camera].group->clocks();
  clocks.enterEpoch(camera, image.clock_epoch,
                    !rig_.cameras[camera].hasNewClock(image.clock_epoch));
  stored->clocks = clocks.version();
  stored->number = images_++;
  stored->full = image.spots.size() >= image.maximum_spots;
  stored->bodies = image.bodies;
  const TrackerCamera& view = cameras_[camera];
  const auto collect = [&](bool masked) {
    for (const Spot& spot : image.spots) {
      if (view.isInImage(spot.pixel, 0.5) && view.isMasked(spot.pixel) == masked &&
          stored->pixels.size() < stored->pixels.capacity())
        stored->pixels.push_back(spot.pixel);
    }
  };
  collect(false);
  stored->spot_count = stored->pixels.size();
  collect(true);
}

void Tracker::updateGroups() {
  for (const auto& group : groups_)
    group->update();
}

const Snapshot* Tracker::next() {
  if (!(newest_time_ > last_output_))
    return nullptr;
  last_output_ = newest_time_;
  updateGroups();
  report(newest_time_, &snapshot_);
  addLost();
  addCalibrationErrors(&snapshot_);
  return &snapshot_;
}

bool Tracker::predictTo(double time, Snapshot* snapshot) {
  if (newest_time_ == kNever || !(time >= newest_time_))
    return false;
  updateGroups();
  report(time, snapshot);
  addCalibrationErrors(snapshot);
  return true;
}

void Tracker::addCalibrationErrors(Snapshot* snapshot) {
  for (TrackedLed& led : snapshot->leds) {
    if (const auto covariance = uncertainty_->covarianceNear(led.position, led.located_by.data(),
                                                             led.located_by.size()))
      led.position_covariance += *covariance;
  }
}

/// Writes the images and all LEDs, without the covariance of the calibration.
void Tracker::report(double time, Snapshot* snapshot) const {
  snapshot->time = time;
  snapshot->latest_arrival = newest_arrival_;
  snapshot->views = views_;
  snapshot->skew = 0.0;
  for (const CameraView& view : views_) {
    if (view.time && *view.time >= time - options_.tracked_time)
      snapshot->skew = std::max(snapshot->skew, time - *view.time);
  }
  std::size_t count = 0;
  for (const auto& group : groups_)
    count += group->tracks().size();
  snapshot->leds.resize(count);
  auto led = snapshot->leds.begin();
  for (const auto& group : groups_) {
    for (const Track& track : group->tracks()) {
      track.report(time, options_, &*led);
      if (led->state == TrackState::kTracked && group->isMisfitPair())
        led->state = TrackState::kPredicted;
      if (track.crowd().isCrowded(time))
        led->position_covariance += mergingCovariance(*led, cameras_, options_.merging_distance);
      ++led;
    }
  }
  std::sort(snapshot->leds.begin(), snapshot->leds.end(), hasSmallerId);
}

/// Adds those whose tracks have ended since the last snapshot.
void Tracker::addLost() {
  std::vector<TrackedLed>& leds = snapshot_.leds;
  const auto count = leds.size();
  for (const TrackedLed& led : before_) {
    if (std::binary_search(leds.begin(), leds.begin() + count, led, hasSmallerId))
      continue;
    TrackedLed& lost = leds.emplace_back(led);
    lost.state = TrackState::kLost;
    lost.cameras.clear();
    lost.rays_possible = 0;
    lost.residual = std::numeric_limits<double>::quiet_NaN();
  }
  before_.assign(leds.begin(), leds.begin() + count);
  std::sort(leds.begin(), leds.end(), hasSmallerId);
}

std::optional<CameraFault> Tracker::cameraFault(std::size_t camera) const {
  if (const std::optional<double> ahead = intake_->ahead(camera))
    return CameraFault{CameraFault::Kind::kWrongClock, *ahead};
  // More than a driver reads at once after a pause.
  constexpr std::size_t kManyLate = 100;
  const Input& input = inputs_[camera];
  if (input.dropped_in_a_row >= kManyLate)
    return CameraFault{CameraFault::Kind::kLate, -input.lateness};
  const CameraGroup& group = *input.group;
  if (group.isMisfit(camera))
    return CameraFault{
        group.isExplained(camera) ? CameraFault::Kind::kInaccurate : CameraFault::Kind::kMisfit,
        0.0};
  constexpr double kNoticeable = 0.004;  // [s]
  const double error = group.clocks().correctionOfKnown(camera);
  if (std::abs(error) >= kNoticeable)
    return CameraFault{CameraFault::Kind::kCorrectedClock, error};
  return std::nullopt;
}

bool Tracker::isDoubtful(std::size_t camera) const {
  const CameraGroup& group = *inputs_[camera].group;
  return group.isMisfitPair() || group.isMisfit(camera);
}

ClockError Tracker::clockError(std::size_t camera, std::uint32_t clock_epoch) const {
  return inputs_.at(camera).group->clocks().correctionIn(
      camera, clock_epoch, !rig_.cameras[camera].hasNewClock(clock_epoch));
}

}  // namespace wiimote_tracker::tracking
