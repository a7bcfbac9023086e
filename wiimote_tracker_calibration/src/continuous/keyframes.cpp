#include "continuous/keyframes.h"

#include "capture/moving_spots.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::continuous {

namespace {

using capture::Spot;

// A resting LED repeats the same rounding.
constexpr double kLeastStep = 0.01;     // [m]
constexpr std::size_t kLeastViews = 3;  // With two none can be found to be the outlier.
// A spot farther from the middle between those before and after is another light. An LED 3 m away
// that accelerates by 10 m/s^2 bends by 5 px between images capture::kLongestGap apart [px].
constexpr double kLargestBend = 8.0;
constexpr double kCheckGate = 10.0;  // Of the keyframes in fitOf() [px].

/// A chord cuts the curve short, which would move the cameras: moves a view from the chord to the
/// curve through two spots before and two after. Not for spots with other lights among them: each
/// would spoil four intervals.
View onCurve(View view, const std::vector<Spot>& spots, double time) {
  const auto after =
      std::lower_bound(spots.begin(), spots.end(), time,
                       [](const Spot& spot, double value) { return spot.time < value; });
  const auto before = after - 1;
  if (before == spots.begin() || after + 1 == spots.end())
    return view;
  const Spot& first = *(before - 1);
  const Spot& last = *(after + 1);
  const double gap = after->time - before->time;
  if (last.time - first.time >= gap + 2.0 * capture::kLongestGap)
    return view;
  // Half the second derivative, which the slopes before and after tell, times since * (since -
  // gap).
  const double since = time - before->time;
  const Eigen::Vector2d bend = (last.pixel - after->pixel) / (last.time - after->time) -
                               (before->pixel - first.pixel) / (before->time - first.time);
  view.pixel +=
      bend / (last.time + after->time - before->time - first.time) * since * (since - gap);
  // Not from before and after: with the pixel's errors the clock would be off. First and last
  // enter the pixel alike, but the velocity with opposite signs.
  view.velocity = (last.pixel - first.pixel) / (last.time - first.time);
  return view;
}

void removeOtherLights(std::vector<Spot>* spots) {
  std::vector<Spot> smooth;
  for (std::size_t i = 1; i + 1 < spots->size(); ++i) {
    const Spot& before = (*spots)[i - 1];
    const Spot& after = (*spots)[i + 1];
    const Spot& spot = (*spots)[i];
    const double share = (spot.time - before.time) / (after.time - before.time);
    const Eigen::Vector2d middle = before.pixel + share * (after.pixel - before.pixel);
    if (after.time - before.time < 2.0 * capture::kLongestGap &&
        (spot.pixel - middle).norm() < kLargestBend)
      smooth.push_back(spot);
  }
  spots->swap(smooth);
}

}  // namespace

KeyframeSource::KeyframeSource(const geometry::Rig& rig, const std::vector<capture::Image>& images)
    : tracks_(rig.cameras.size()) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    for (const capture::Image& image :
         capture::latestImagesOf(rig.cameras[i].camera.name, images)) {
      track.epoch = image.clock_epoch;
      capture::append(image.stamp, image, &track.spots);
    }
    removeOtherLights(&track.spots);
  }
}

std::optional<std::uint32_t> KeyframeSource::epoch(std::size_t camera) const {
  return tracks_[camera].epoch;
}

double KeyframeSource::nextSpot(const geometry::Rig& rig, double time) const {
  double next = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const std::vector<Spot>& spots = tracks_[i].spots;
    const double offset = rig.cameras[i].time_offset;
    const auto after =
        std::upper_bound(spots.begin(), spots.end(), time - offset,
                         [](double value, const Spot& spot) { return value < spot.time; });
    if (after != spots.end())
      next = std::min(next, after->time + offset);
  }
  return next;
}

std::vector<Keyframe> KeyframeSource::keyframes(const geometry::Rig& rig, double gate) const {
  std::vector<geometry::Camera> cameras;
  double begin = std::numeric_limits<double>::infinity();
  double end = -begin;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    cameras.push_back(rig.rayCamera(rig.cameras[i]));
    if (tracks_[i].spots.empty())
      continue;
    begin = std::min(begin, tracks_[i].spots.front().time);
    end = std::max(end, tracks_[i].spots.back().time);
  }
  std::vector<Keyframe> keyframes;
  for (double time = begin; time < end; time += capture::kSamplePeriod) {
    std::vector<View> views;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      const double stamp = time - rig.cameras[i].time_offset;
      if (const auto view = capture::viewAt(i, tracks_[i].spots, stamp))
        views.push_back(onCurve(*view, tracks_[i].spots, stamp));
    }
    if (views.empty())  // A pause, or a step of the clock, may take years.
      time = std::max(time, nextSpot(rig, time) - capture::kSamplePeriod);
    const auto found = capture::locate(cameras, views, gate, kLeastViews);
    if (!found || (!keyframes.empty() &&
                   (found->point.position - keyframes.back().point).norm() <= kLeastStep))
      continue;
    const double squared = std::pow(found->point.reprojection_error, 2);
    keyframes.push_back(
        {found->point.position, found->views, squared * static_cast<double>(found->views.size())});
  }
  return keyframes;
}

double rmsResidual(const std::vector<Keyframe>& keyframes) {
  double squared = 0.0;
  double freedom = 0.0;
  for (const Keyframe& keyframe : keyframes) {
    squared += keyframe.squared;
    freedom += 2.0 * static_cast<double>(keyframe.views.size()) - 3.0;
  }
  return std::sqrt(squared / std::max(1.0, freedom));
}

std::optional<Fit> fitOf(const geometry::Rig& rig, const std::vector<capture::Image>& images) {
  const KeyframeSource source(rig, images);
  geometry::Rig valid = rig;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    valid.cameras[i].time_offset =
        rig.cameras[i].timeOffsetIn(source.epoch(i).value_or(0)).value_or(0.0);
  const auto keyframes = source.keyframes(valid, kCheckGate);
  if (keyframes.size() < kLeastKeyframes)
    return std::nullopt;
  Fit fit{rmsResidual(keyframes), {}};
  for (const Keyframe& keyframe : keyframes)
    fit.places.push_back(keyframe.point);
  return fit;
}

}  // namespace wiimote_tracker::continuous
