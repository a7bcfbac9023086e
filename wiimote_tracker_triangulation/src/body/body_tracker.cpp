#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include "association/shared_views.h"
#include "body/body_search.h"
#include "body/body_setup.h"
#include "body/body_state.h"
#include "body/body_update.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace wiimote_tracker::body {
namespace {

/// Images that may be computed again per new image, because samples of an IMU came later.
constexpr std::size_t kRepeats = 16;

}  // namespace

BodyTracker::BodyTracker(const geometry::Rig& rig,
                         const std::vector<Constellation>& constellations,
                         const BodyTrackerOptions& options)
    : setup_(std::make_unique<BodySetup>()),
      state_(std::make_unique<BodyState>()),
      history_(std::make_unique<BodyHistory>()),
      update_(std::make_unique<BodyUpdate>(*setup_, state_.get())),
      image_(std::make_unique<BodyImage>()) {
  setup_->options = options;
  rig.check();
  useRig(rig);
  setBodies(constellations);
}

BodyTracker::~BodyTracker() = default;

void BodyTracker::useRig(const geometry::Rig& rig) {
  setup_->rig = rig;
  setup_->cameras = rig.rayCameras();
  setup_->partners = association::sharedViews(rig, setup_->options.maximum_range);
  search_ = std::make_unique<BodySearch>(*setup_, state_.get(), update_.get());
  state_->images.assign(rig.cameras.size(), {});
}

void BodyTracker::setRig(const geometry::Rig& rig) {
  rig.check();
  auto images = history_->images();
  if (!images.empty())
    history_->rollBack(images.begin(), state_.get());
  history_->clear();
  const std::vector<geometry::RigCamera> before = setup_->rig.cameras;
  useRig(rig);
  for (std::uint64_t i = images.begin(); i < images.end(); ++i) {
    BodyImage& image = images.at(i);
    const auto same = std::find_if(rig.cameras.begin(), rig.cameras.end(), [&](const auto& camera) {
      return camera.camera.name == before[image.camera].camera.name;
    });
    if (same == rig.cameras.end())
      continue;
    image.camera = same - rig.cameras.begin();
    history_->insert(history_->images().end(), image);
    step(history_->images().end() - 1);
  }
  for (std::optional<KnownBody>& body : state_->bodies) {
    if (body && time_ - body->last_observed > setup_->options.tracked_time)
      body.reset();
  }
  estimate();
}

void BodyTracker::setBodies(const std::vector<Constellation>& constellations) {
  for (const Constellation& constellation : constellations)
    constellation.check();
  const auto before = std::exchange(setup_->bodies, {});
  std::vector<std::size_t> former;  // index of each body, or the number of bodies if it is new
  for (const Constellation& constellation : constellations) {
    const auto same = std::find_if(before.begin(), before.end(), [&](const BodyModel& body) {
      return body.constellation == constellation;
    });
    former.push_back(same - before.begin());
    setup_->bodies.push_back(same != before.end() ? *same : BodyModel(constellation));
  }
  const auto carryOver = [&](BodyState* state) {
    const auto bodies = std::exchange(state->bodies, {});
    for (const std::size_t body : former)
      state->bodies.push_back(body < bodies.size() ? bodies[body] : std::nullopt);
    state->images.assign(setup_->cameras.size(), {});  // their spots name bodies by index
  };
  carryOver(state_.get());
  history_->changeStates(carryOver);
  auto& images = history_->images();
  for (std::uint64_t i = images.begin(); i < images.end(); ++i) {
    for (const BodyImage::LabelStart& start : std::exchange(images.at(i).starts, {})) {
      const auto now = std::find(former.begin(), former.end(), start.body);
      if (now != former.end())
        images.at(i).starts.push_back({static_cast<std::size_t>(now - former.begin()), start.pose});
    }
  }
  estimates_.assign(setup_->bodies.size(), std::nullopt);
  estimate();
}

void BodyTracker::reset() {
  state_->bodies.assign(setup_->bodies.size(), std::nullopt);
  state_->images.assign(setup_->cameras.size(), {});
  history_->clear();
  for (BodyModel& body : setup_->bodies)
    body.inertial.clear();
  inertial_change_ = std::numeric_limits<double>::infinity();
  time_ = -std::numeric_limits<double>::infinity();
  estimates_.assign(setup_->bodies.size(), std::nullopt);
}

bool BodyTracker::add(std::size_t camera,
                      double time,
                      double stamp_stddev,
                      const std::vector<Eigen::Vector2d>& pixels,
                      bool is_doubtful) {
  taken_.assign(pixels.size(), false);
  fit_ = {};
  image_->camera = camera;
  image_->time = time;
  image_->stamp_stddev = stamp_stddev;
  image_->pixels = pixels;
  image_->is_doubtful = is_doubtful;
  const auto place = history_->placeOf(*image_);
  if (!place || time < time_ - setup_->options.history)
    return false;
  const auto& images = std::as_const(*history_).images();
  std::uint64_t next = firstOutdated(*place);
  if (next < images.end())
    next = history_->rollBack(next, state_.get());
  history_->insert(*place, *image_);
  for (; next < images.end(); ++next) {
    step(next);
    if (next == *place) {
      taken_ = update_->taken();
      fit_ = update_->fit();
    }
  }
  time_ = std::max(time_, time);
  history_->forgetBefore(time_ - setup_->options.history);
  estimate();
  return true;
}

/// The first image before `place` for which a sample of an IMU came too late, or `place`. If they
/// are many, waits for more new images.
std::uint64_t BodyTracker::firstOutdated(std::uint64_t place) {
  const auto& images = history_->images();
  std::uint64_t first = place;
  while (first > images.begin() && images.at(first - 1).time > inertial_change_)
    --first;
  ++images_since_repeat_;
  if (place - first > kRepeats * images_since_repeat_)
    return place;
  images_since_repeat_ = 0;
  inertial_change_ = std::numeric_limits<double>::infinity();
  return first;
}

void BodyTracker::addInertial(std::size_t body, const InertialSample& sample) {
  inertial_change_ = std::min(inertial_change_, setup_->bodies[body].inertial.add(sample));
}

void BodyTracker::step(std::uint64_t place) {
  history_->keep(place, *state_);
  const BodyImage& image = history_->images().at(place);
  update_->follow(image);
  dropLost(image.time);
  search_->find(image);
  for (const BodyImage::LabelStart& start : image.starts) {
    if (!state_->bodies[start.body])
      state_->bodies[start.body].emplace(setup_->options, image.time, start.pose, 0);
  }
}

void BodyTracker::dropLost(double time) {
  for (std::optional<KnownBody>& body : state_->bodies) {
    if (body && (time - body->last_observed > setup_->options.prediction_time ||
                 !body->filter.state().poseCovariance().allFinite()))
      body.reset();
  }
}

}  // namespace wiimote_tracker::body
