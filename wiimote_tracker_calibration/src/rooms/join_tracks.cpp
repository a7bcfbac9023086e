#include "rooms/join_tracks.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace wiimote_tracker::rooms {

namespace {

// Tracks of one LED are nearer to each other, those of two people are not [m].
constexpr double kNear = 0.2;
// An LED is lost for a moment, while it goes on nearly as before [s].
constexpr double kMoment = 0.5;
// Its velocity is measured for so long [s].
constexpr double kMeasured = 0.3;

/// Between the points of a path, or as it would go on from two of them.
Eigen::Vector3d positionAt(const PathPoint& a, const PathPoint& b, double time) {
  const double share = b.time > a.time ? (time - a.time) / (b.time - a.time) : 0.0;
  return a.position + share * (b.position - a.position);
}

/// Whether the mean distance over the times of both is small.
bool goesAlong(const Path& path, const Path& other) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const PathPoint& point : other) {
    const auto after =
        std::lower_bound(path.begin(), path.end(), point.time,
                         [](const PathPoint& one, double time) { return one.time < time; });
    if (after == path.end())
      break;
    const PathPoint& before = after == path.begin() ? *after : *(after - 1);
    sum += (positionAt(before, *after, point.time) - point.position).norm();
    ++count;
  }
  return count > 0 && sum <= kNear * static_cast<double>(count);
}

bool goesOn(const Path& path, const PathPoint& next) {
  const PathPoint& last = path.back();
  if (next.time > last.time + kMoment)
    return false;
  const auto earlier = std::find_if(path.rbegin(), path.rend(), [&](const PathPoint& point) {
    return point.time <= last.time - kMeasured;
  });
  const PathPoint& before = earlier == path.rend() ? path.front() : *earlier;
  return (positionAt(before, last, next.time) - next.position).norm() <= kNear;
}

}  // namespace

std::vector<Path> joinTracks(std::vector<Path> tracks) {
  tracks.erase(
      std::remove_if(tracks.begin(), tracks.end(), [](const Path& track) { return track.empty(); }),
      tracks.end());
  std::stable_sort(tracks.begin(), tracks.end(),
                   [](const Path& a, const Path& b) { return a.front().time < b.front().time; });
  std::vector<Path> joined;
  for (Path& track : tracks) {
    const auto same = std::find_if(joined.begin(), joined.end(), [&](const Path& path) {
      return track.front().time <= path.back().time ? goesAlong(path, track)
                                                    : goesOn(path, track.front());
    });
    if (same == joined.end()) {
      joined.push_back(std::move(track));
      continue;
    }
    const double end = same->back().time;
    std::copy_if(track.begin(), track.end(), std::back_inserter(*same),
                 [end](const PathPoint& point) { return point.time > end; });
  }
  return joined;
}

}  // namespace wiimote_tracker::rooms
