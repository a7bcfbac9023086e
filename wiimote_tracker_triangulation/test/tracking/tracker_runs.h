#pragma once

#include "tracking/identity_check.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <cstdint>
#include <set>
#include <vector>

namespace wiimote_tracker::tracking::test {

std::vector<SceneImage> imagesOf(const geometry::Rig& rig,
                                 const std::vector<Path>& leds,
                                 const SceneOptions& options,
                                 int count,
                                 unsigned seed = 1);

/// Adds images and returns all snapshots.
std::vector<Snapshot> track(Estimator* tracker, const std::vector<SceneImage>& images);

Snapshot stateAt(Tracker& tracker, double time);

/// Expects the same LEDs, at least one, bit for bit, whatever their ids.
void expectSameLeds(Snapshot a, Snapshot b);

std::set<std::uint32_t> idsIn(const Snapshot& snapshot, TrackState state);

}  // namespace wiimote_tracker::tracking::test
