#include "rooms/passages.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

/// Joins the tracks of one room that are of the same LED: one that goes along another one, and one
/// that goes on where another one was lost a moment ago.
/// @param tracks points in the order of time. @returns paths in the order of their beginnings.
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

constexpr double kSpacing = 0.1;  // Of a thinned path; deviations are correlated for longer [s].
constexpr double kLongestPart = 3.0;  // Of each track, next to the door [s].
// RMS distance of a part from its line over that of the model; of walks by the model 0.1 to 0.4 %
// exceed it (simulated).
constexpr double kMostCrooked = 1.7;

/// The part of a track next to its end or beginning, in the order of time.
Path partOf(const Path& track, bool end, double duration) {
  Path part;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const PathPoint& point = end ? track[track.size() - 1 - i] : track[i];
    if (!part.empty()) {
      if (std::abs(point.time - part.front().time) > duration)
        break;
      if (std::abs(point.time - part.back().time) < kSpacing)
        continue;
    }
    part.push_back(point);
  }
  if (end)
    std::reverse(part.begin(), part.end());
  return part;
}

double durationOf(const Path& path) {
  return path.empty() ? 0.0 : path.back().time - path.front().time;
}

/// A track that ends or begins while the LED moves.
struct End {
  double time;
  bool in_first;
  const Path* track;
};

bool isCarried(const Path& track, bool end) {
  if (durationOf(track) < kShortestPart)
    return false;
  const Path part = partOf(track, end, kShortestPart);
  const double length = (part.back().position - part.front().position).norm();
  return length > kSlowest * durationOf(part);
}

std::vector<End> endsOf(const std::vector<Path>& first, const std::vector<Path>& second, bool end) {
  std::vector<End> ends;
  for (const std::vector<Path>* room : {&first, &second}) {
    for (const Path& track : *room) {
      if (isCarried(track, end))
        ends.push_back({end ? track.back().time : track.front().time, room == &first, &track});
    }
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const End& a, const End& b) { return a.time < b.time; });
  return ends;
}

/// The longest part that is straight; empty: none.
Path straightPart(const Path& track, bool end) {
  for (double duration = kLongestPart; duration >= kShortestPart; duration -= 0.25) {
    Path part = partOf(track, end, duration);
    if (durationOf(part) >= kShortestPart - kSpacing && crookednessOf(part) <= kMostCrooked)
      return part;
  }
  return {};
}

}  // namespace

Passages findPassages(const std::vector<Path>& first_tracks,
                      const std::vector<Path>& second_tracks) {
  const std::vector<Path> first = joinTracks(first_tracks);
  const std::vector<Path> second = joinTracks(second_tracks);
  const std::vector<End> exits = endsOf(first, second, true);
  const std::vector<End> entries = endsOf(first, second, false);
  // An LED that was hidden within a room competes with those that change rooms.
  const auto follows = [&](const End& entry, const End& exit) {
    const double hidden = entry.time - exit.time;
    return hidden > 0.0 && hidden <= kLongestHidden;
  };
  Passages result;
  for (const End& exit : exits) {
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const End& other) {
      return exit.in_first != other.in_first && follows(other, exit);
    });
    if (entry == entries.end()) {
      result.unhidden += static_cast<std::size_t>(
          std::any_of(entries.begin(), entries.end(), [&](const End& other) {
            return other.in_first != exit.in_first && other.time <= exit.time &&
                   other.time > exit.track->front().time && other.track->back().time > exit.time;
          }));
      continue;
    }
    const auto rivals = std::count_if(entries.begin(), entries.end(),
                                      [&](const End& other) { return follows(other, exit); }) +
                        std::count_if(exits.begin(), exits.end(),
                                      [&](const End& other) { return follows(*entry, other); }) -
                        2;
    if (rivals > 0) {
      ++result.crowded;
      continue;
    }
    const Passage passage{exit.in_first, straightPart(*exit.track, true),
                          straightPart(*entry->track, false)};
    if (passage.before.empty() || passage.after.empty())
      ++result.crooked;
    else
      result.passages.push_back(passage);
  }
  return result;
}

}  // namespace wiimote_tracker::rooms
