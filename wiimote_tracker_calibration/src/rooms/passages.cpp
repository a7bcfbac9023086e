#include "rooms/passages.h"

#include "rooms/join_tracks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::rooms {

namespace {

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
