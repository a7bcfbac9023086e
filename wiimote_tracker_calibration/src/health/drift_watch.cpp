#include "health/drift_watch.h"

#include "drift_residuals.h"
#include "exchanged_cameras.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::health {

namespace {

// Longest wait of a sample for images.
constexpr double kPatience = 0.1;  // [s]
// A larger step of the time is a jump of the clock.
constexpr double kJump = 1.0;  // [s]
// A still LED repeats the same rounding: the next sample is at least this far away.
constexpr double kLeastMotion = 2.0;  // [px]
// Error of a camera's clock with a valid offset, and how far an error may shift a spot: spots
// faster than 1000 px/s take no part, without a valid offset those faster than 100 px/s.
constexpr double kKnownOffset = 0.0005;  // [s]
constexpr double kLargestShift = 0.5;    // [px]
// Judgements per window.
constexpr double kJudgements = 12.0;
// The window grows to so many times its length while samples lack.
constexpr double kLongest = 4.0;
// Residuals of a camera that scatter by more are not those of a turn alone [px].
constexpr double kMisplaced = 10.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Judges a rig by samples of one LED.
class Judgement {
 public:
  Judgement(const geometry::Rig& rig, const DriftSamples& samples, double limit)
      : rig_(rig), samples_(samples), limit_(limit) {}

  Drifts judge();

 private:
  std::optional<double> worstRatio(const std::vector<bool>& active) const;
  void judgeAgainstOthers(std::vector<bool>* active);
  void judgePairs(const std::vector<bool>& active);
  void noteExchange(std::vector<bool>* active);

  const geometry::Rig& rig_;
  const DriftSamples& samples_;
  double limit_;
  Drifts drifts_;
};

/// The largest ratio among these cameras; nothing: none can be judged.
std::optional<double> Judgement::worstRatio(const std::vector<bool>& active) const {
  std::optional<double> worst;
  for (std::size_t a = 0; a < active.size(); ++a) {
    if (!active[a])
      continue;
    if (const auto drift = driftOf(a, rig_, samples_, active, limit_)) {
      worst = std::max(worst.value_or(0.0), drift->ratio);
      continue;
    }
    for (std::size_t b = 0; b < active.size(); ++b) {
      const auto pair =
          active[b] && b != a ? driftOfPair(a, b, rig_, samples_, limit_) : std::nullopt;
      if (pair)
        worst = std::max(worst.value_or(0.0), pair->ratio);
    }
  }
  return worst;
}

Drifts Judgement::judge() {
  drifts_.assign(rig_.cameras.size(), std::nullopt);
  std::vector<bool> active(rig_.cameras.size(), true);
  judgeAgainstOthers(&active);
  if (std::any_of(drifts_.begin(), drifts_.end(),
                  [](const auto& drift) { return drift && drift->scatter > kMisplaced; }))
    noteExchange(&active);
  judgePairs(active);
  return drifts_;
}

/// Judges the others without two cameras that seem exchanged, if there are such.
void Judgement::noteExchange(std::vector<bool>* active) {
  const auto exchanged = exchangedCameras(rig_, samples_);
  if (!exchanged)
    return;
  const auto [a, b] = *exchanged;
  Drifts found(rig_.cameras.size());
  for (const std::size_t i : {a, b}) {
    found[i] = drifts_[i].value_or(Drift());
    found[i]->ratio = std::max(1.0, found[i]->ratio);
    found[i]->exchanged_with = rig_.cameras[i == a ? b : a].camera.name;
  }
  drifts_ = found;
  active->assign(rig_.cameras.size(), true);
  (*active)[a] = (*active)[b] = false;
  judgeAgainstOthers(active);
}

/// Removes the cameras that drifted, one after the other.
void Judgement::judgeAgainstOthers(std::vector<bool>* remaining) {
  std::vector<bool>& active = *remaining;
  // A camera that drifted moves the points of the others, so that they seem to drift too. Remove
  // the camera without which the rest fit best, and judge the rest without it.
  while (true) {
    double least = 0.0;
    std::optional<std::size_t> culprit;
    for (std::size_t i = 0; i < rig_.cameras.size(); ++i) {
      if (!active[i])
        continue;
      drifts_[i] = driftOf(i, rig_, samples_, active, limit_);
      if (!drifts_[i] || drifts_[i]->ratio < 1.0)
        continue;
      std::vector<bool> rest = active;
      rest[i] = false;
      // Cameras that share too little do not fit for that.
      const double worst = worstRatio(rest).value_or(std::numeric_limits<double>::infinity());
      if (!culprit || worst < least) {
        least = worst;
        culprit = i;
      }
    }
    if (!culprit)
      break;
    active[*culprit] = false;
  }
  // Where several are removed, two that remain may agree by chance.
  const auto removed = std::count(active.begin(), active.end(), false);
  std::size_t judged = 0;
  for (std::size_t i = 0; i < active.size(); ++i)
    judged += active[i] && drifts_[i] ? 1 : 0;
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (!active[i])
      drifts_[i]->or_others = removed > 1 && judged < 3;
  }
}

/// Judges cameras that share their view with one other camera only.
void Judgement::judgePairs(const std::vector<bool>& active) {
  for (std::size_t a = 0; a < rig_.cameras.size(); ++a) {
    for (std::size_t b = a + 1; b < rig_.cameras.size(); ++b) {
      if (!active[a] || !active[b] || (drifts_[a] && drifts_[b]))
        continue;
      const auto pair = driftOfPair(a, b, rig_, samples_, limit_);
      if (!pair)
        continue;
      for (const std::size_t i : {a, b}) {
        const bool fits_the_others = drifts_[i] && drifts_[i]->or_camera.empty();
        if (fits_the_others || (drifts_[i] && drifts_[i]->ratio >= pair->ratio))
          continue;
        drifts_[i] = pair;
        drifts_[i]->or_camera = rig_.cameras[i == a ? b : a].camera.name;
      }
    }
  }
}

}  // namespace

Drifts driftsOf(const geometry::Rig& rig, const std::vector<capture::Image>& images) {
  DriftOptions options;
  options.window = std::numeric_limits<double>::infinity();
  DriftWatch watch(rig, options);
  for (const capture::Image& image : images)
    watch.add(image);
  watch.judge();
  return watch.drifts();
}

bool allFit(const Drifts& drifts, std::ptrdiff_t cameras) {
  const auto judged = std::count_if(drifts.begin(), drifts.end(),
                                    [](const auto& drift) { return drift.has_value(); });
  return judged >= cameras && std::none_of(drifts.begin(), drifts.end(), [](const auto& drift) {
           return drift && drift->ratio >= 1.0;
         });
}

DriftWatch::DriftWatch(const geometry::Rig& rig, const DriftOptions& options)
    : rig_(rig), options_(options), drifts_(rig.cameras.size()) {
  for (const geometry::RigCamera& camera : rig_.cameras)
    cameras_.push_back({rig_.rayCamera(camera), {}, false, 0.0, 0, std::nullopt});
}

bool DriftWatch::add(const capture::Image& image) {
  const auto found = std::find_if(cameras_.begin(), cameras_.end(), [&](const Camera& camera) {
    return camera.rays.name == image.camera;
  });
  if (found == cameras_.end() || rig_.ray_model != geometry::RayModel::kCalibrated)
    return false;
  const geometry::RigCamera& calibrated =
      rig_.cameras[static_cast<std::size_t>(found - cameras_.begin())];
  const auto time_offset = calibrated.timeOffsetIn(image.clock_epoch);
  found->clock_known = time_offset.has_value();
  const double time = image.stamp + time_offset.value_or(0.0);
  if (!std::isfinite(time))
    return false;
  const double late = newest_ - time;
  const std::size_t later_than = newest_camera_;
  if (std::isinf(newest_) || time - newest_ > options_.window + kJump || time < newest_ - kJump) {
    restart();
    newest_ = time;
    next_sample_ = time;
    next_judgement_ = time + options_.window / kJudgements;
  }
  found->late = late;
  found->later_than = later_than;
  // Behind an image with no or several lights there may be another light.
  if (found->spots.empty() || time > found->spots.back().time)
    found->spots.push_back(
        {time, image.spots.size() == 1 ? image.spots.front() : Eigen::Vector2d::Constant(kNan)});
  if (time >= newest_) {
    newest_ = time;
    newest_camera_ = static_cast<std::size_t>(found - cameras_.begin());
  }
  sampleUntil(newest_ - kPatience);
  if (newest_ < next_judgement_)
    return false;
  next_judgement_ = newest_ + options_.window / kJudgements;
  judge();
  return true;
}

void DriftWatch::judge() {
  drifts_ = Judgement(rig_, samples_, options_.limit).judge();
}

std::string DriftWatch::whyNotJudged(std::size_t camera) const {
  if (rig_.ray_model != geometry::RayModel::kCalibrated)
    return "the rig's rays are built through the image centre";
  // An image later than kJump begins everything anew.
  const auto latest =
      std::max_element(cameras_.begin(), cameras_.end(),
                       [](const Camera& a, const Camera& b) { return a.late < b.late; });
  const Camera& late = latest->late > kJump ? *latest : cameras_[camera];
  if (late.late > kPatience)
    return format(
        "images of %s come %.2f s later than those of %s: see their links, and the clocks of their "
        "computers",
        late.rays.name.c_str(), late.late, cameras_[late.later_than].rays.name.c_str());
  return "no LED has moved lately where it and others see it";
}

void DriftWatch::restart() {
  for (Camera& camera : cameras_) {
    camera.spots.clear();
    camera.late = 0.0;
    camera.last_sample.reset();
  }
  samples_.clear();
  drifts_.assign(cameras_.size(), std::nullopt);
}

void DriftWatch::sampleUntil(double time) {
  if (next_sample_ < time - kJump)
    next_sample_ = time;
  for (; next_sample_ <= time; next_sample_ += capture::kSamplePeriod)
    sampleAt(next_sample_);
  while (!samples_.empty() && samples_.front().time < time - options_.window &&
         (hasEnoughSamples() || samples_.front().time < time - kLongest * options_.window))
    samples_.pop_front();
}

bool DriftWatch::hasEnoughSamples() const {
  const auto enough = std::count_if(samples_.begin(), samples_.end(),
                                    [](const auto& sample) { return sample.sights.size() >= 3; });
  return static_cast<std::size_t>(enough) >= options_.samples;
}

void DriftWatch::sampleAt(double time) {
  DriftSample sample{time, {}};
  std::vector<capture::View> views;
  bool has_moved = false;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    Camera& camera = cameras_[i];
    while (camera.spots.size() > 1 && camera.spots[1].time < time)
      camera.spots.erase(camera.spots.begin());
    const auto view = capture::viewAt(i, camera.spots, time);
    const double clock_error = camera.clock_known ? kKnownOffset : capture::kUnknownOffset;
    if (!view || view->velocity.norm() * clock_error > kLargestShift)
      continue;
    const auto sight = geometry::sightFromPixel(camera.rays, view->pixel);
    if (!sight)
      continue;
    has_moved = has_moved || !camera.last_sample ||
                (view->pixel - *camera.last_sample).norm() > kLeastMotion;
    views.push_back(*view);
    sample.sights.emplace_back(i, *sight);
  }
  if (views.size() < 2 || !has_moved)
    return;
  for (const capture::View& view : views)
    cameras_[view.camera].last_sample = view.pixel;
  samples_.push_back(std::move(sample));
}

}  // namespace wiimote_tracker::health
