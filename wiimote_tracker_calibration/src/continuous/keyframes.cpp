#include "continuous/keyframes.h"

#include <wiimote_tracker_triangulation/geometry/sight.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::continuous {

namespace {

using capture::Spot;

// A resting LED repeats the same rounding.
constexpr double kLeastStep = 0.01;     // [m]
constexpr std::size_t kLeastViews = 3;  // With two none can be found to be the outlier.
// A spot farther from the middle between those before and after is another light. An LED 3 m away
// that accelerates by 10 m/s^2 bends by 5 px between images capture::kLongestGap apart [px].
constexpr double kLargestBend = 8.0;

/// Triangulates the views. @returns whether they agree within the gate [px].
bool locate(const std::vector<geometry::Sight>& sights, double gate, Keyframe* keyframe) {
  const auto point = geometry::triangulate(sights.data(), sights.size(), {});
  if (sights.size() < kLeastViews || !point || point->reprojection_error > gate)
    return false;
  keyframe->point = point->position;
  keyframe->squared =
      point->reprojection_error * point->reprojection_error * static_cast<double>(sights.size());
  return true;
}

/// The same without the view that fits worst, if all do not agree.
bool locateWithoutOutlier(const std::vector<geometry::Camera>& cameras,
                          double gate,
                          Keyframe* keyframe) {
  std::vector<geometry::Sight> sights;
  std::vector<View> views;
  for (const View& view : keyframe->views) {
    if (const auto sight = geometry::sightFromPixel(cameras[view.camera], view.pixel)) {
      sights.push_back(*sight);
      views.push_back(view);
    }
  }
  keyframe->views = views;
  if (locate(sights, gate, keyframe))
    return true;
  std::optional<std::size_t> outlier;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < views.size(); ++i) {
    std::vector<geometry::Sight> others = sights;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    Keyframe without;
    if (!locate(others, gate, &without) || without.squared >= least)
      continue;
    least = without.squared;
    outlier = i;
    keyframe->point = without.point;
    keyframe->squared = without.squared;
  }
  if (!outlier)
    return false;
  keyframe->views.erase(keyframe->views.begin() + static_cast<std::ptrdiff_t>(*outlier));
  return true;
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

std::optional<View> KeyframeSource::viewAt(std::size_t camera, double stamp) const {
  const std::vector<Spot>& spots = tracks_[camera].spots;
  const auto found = capture::bracket(spots, stamp);
  if (!found)
    return std::nullopt;
  const auto [before, after] = *found;
  const double gap = found->gap();
  const double time = stamp - before->time;
  const Eigen::Vector2d velocity = (after->pixel - before->pixel) / gap;
  View view{camera, before->pixel + time * velocity, velocity};
  // A chord cuts the curve short, which would move the cameras: add half the second derivative,
  // which the slopes before and after tell, times time * (time - gap).
  if (before != &spots.front() && after != &spots.back()) {
    const Spot& first = *(before - 1);
    const Spot& last = *(after + 1);
    if (last.time - first.time < gap + 2.0 * capture::kLongestGap) {
      const Eigen::Vector2d bend = (last.pixel - after->pixel) / (last.time - after->time) -
                                   (before->pixel - first.pixel) / (before->time - first.time);
      view.pixel +=
          bend / (last.time + after->time - before->time - first.time) * time * (time - gap);
      // Not from before and after: with the pixel's errors the clock would be off. First and last
      // enter the pixel alike, but the velocity with opposite signs.
      view.velocity = (last.pixel - first.pixel) / (last.time - first.time);
    }
  }
  return view;
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
    Keyframe keyframe;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      if (const auto view = viewAt(i, time - rig.cameras[i].time_offset))
        keyframe.views.push_back(*view);
    }
    if (keyframe.views.empty())  // A pause, or a step of the clock, may take years.
      time = std::max(time, nextSpot(rig, time) - capture::kSamplePeriod);
    if (locateWithoutOutlier(cameras, gate, &keyframe) &&
        (keyframes.empty() || (keyframe.point - keyframes.back().point).norm() > kLeastStep))
      keyframes.push_back(std::move(keyframe));
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

}  // namespace wiimote_tracker::continuous
