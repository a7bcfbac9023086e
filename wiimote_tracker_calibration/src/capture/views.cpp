#include "capture/views.h"

#include <wiimote_tracker_triangulation/geometry/sight.h>

#include <algorithm>

namespace wiimote_tracker::capture {

void append(double time, const Image& image, std::vector<Spot>* spots) {
  if (image.spots.size() == 1 && (spots->empty() || time > spots->back().time))
    spots->push_back({time, image.spots.front()});
}

std::optional<View> viewAt(std::size_t camera, const std::vector<Spot>& spots, double time) {
  const auto after =
      std::lower_bound(spots.begin(), spots.end(), time,
                       [](const Spot& spot, double value) { return spot.time < value; });
  if (after == spots.end() || after == spots.begin())
    return std::nullopt;
  const auto before = after - 1;
  const double gap = after->time - before->time;
  const Eigen::Vector2d step = after->pixel - before->pixel;
  if (gap > kLongestGap || !(step.norm() <= kLongestJump))
    return std::nullopt;
  return View{camera, before->pixel + (time - before->time) / gap * step, step / gap};
}

std::optional<Located> locate(const std::vector<geometry::Camera>& cameras,
                              const std::vector<View>& views,
                              double gate,
                              std::size_t least) {
  std::vector<View> seen;
  std::vector<geometry::Sight> sights;
  for (const View& view : views) {
    if (const auto sight = geometry::sightFromPixel(cameras[view.camera], view.pixel)) {
      seen.push_back(view);
      sights.push_back(*sight);
    }
  }
  geometry::TriangulationOptions options;
  options.pixel_stddev = 1.0;
  const auto pointOf = [&](const std::vector<geometry::Sight>& some, double limit) {
    auto point = some.size() < least ? std::nullopt
                                     : geometry::triangulate(some.data(), some.size(), options);
    return point && point->reprojection_error > limit ? std::nullopt : point;
  };
  if (const auto point = pointOf(sights, gate))
    return Located{*point, seen};
  std::optional<Located> best;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::vector<geometry::Sight> others = sights;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto point = pointOf(others, best ? best->point.reprojection_error : gate);
    if (!point)
      continue;
    best = Located{*point, seen};
    best->views.erase(best->views.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return best;
}

}  // namespace wiimote_tracker::capture
