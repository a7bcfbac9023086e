#include "workflow/captured.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace wiimote_tracker::workflow {

namespace {

// A length farther from that of the sides than this is a mistake [standard deviations].
constexpr double kMostDeviation = 10.0;

/// @returns whether any was dropped.
template <typename Condition>
bool dropLengths(Condition condition, Captured* captured) {
  std::vector<square::TapedLength>& lengths = captured->layout->lengths;
  const auto latest = lengths.end() - static_cast<std::ptrdiff_t>(captured->latest_lengths);
  captured->latest_lengths -=
      static_cast<std::size_t>(std::count_if(latest, lengths.end(), condition));
  const auto end = std::remove_if(lengths.begin(), lengths.end(), condition);
  const bool any = end != lengths.end();
  lengths.erase(end, lengths.end());
  return any;
}

wave::CameraRecording recordingOf(const Captured& captured,
                                  const std::string& name,
                                  const CameraFacts& facts) {
  wave::CameraRecording camera;
  if (const auto fact = facts.find(name); fact != facts.end())
    camera.sightings = fact->second;
  camera.sightings.name = name;
  // The one that is connected now may be another.
  if (const auto device = captured.devices.find(name); device != captured.devices.end())
    camera.sightings.identity = device->second;
  for (std::size_t c = 0; c < captured.square.corners().size(); ++c) {
    const auto view = captured.square.corners()[c].find(name);
    if (view != captured.square.corners()[c].end())
      camera.sightings.corners[c] = view->second.pixel;
  }
  for (const capture::CapturedCorner& place : captured.places) {
    const auto view = place.find(name);
    camera.sightings.places.push_back(
        view != place.end() ? std::optional<Eigen::Vector2d>(view->second.pixel) : std::nullopt);
  }
  const WaveRecorder::Track* track = captured.wave ? captured.wave->track(name) : nullptr;
  if (track != nullptr) {
    camera.clock_epoch = track->clock_epoch;
    camera.frames = track->frames;
  }
  return camera;
}

std::optional<WaveRecorder> waveOf(const wave::Recording& recording,
                                   const wave::CoverageOptions& options) {
  if (!recording.hasFrames())
    return std::nullopt;
  std::vector<geometry::Camera> cameras;
  for (const wave::CameraRecording& camera : recording.cameras)
    cameras.push_back(camera.sightings.camera());
  WaveRecorder wave(cameras, false, recording.wand, options, recording.span().first);
  for (const wave::CameraRecording& camera : recording.cameras) {
    for (const wave::Frame& frame : camera.frames)
      wave.add({camera.sightings.name, frame.stamp, camera.clock_epoch, frame.spots, {}});
  }
  return wave;
}

}  // namespace

void Captured::noteDevice(const std::string& camera, const std::string& identity) {
  if (identity.empty() || std::count(cameras.begin(), cameras.end(), camera) == 0)
    return;
  if (devices.emplace(camera, identity).first->second != identity)
    other_devices[camera] = identity;
}

std::string Captured::whyNotSolvable() const {
  if (cameras.empty())
    return "no calibration is started: start one first";
  if (!isComplete() && layout)
    return "only " + std::to_string(square.corners().size()) +
           " of 4 corners are captured: capture the others first";
  if (!isComplete())
    return "no wand was waved: record one first";
  if (other_devices.empty())
    return "";
  const auto& [name, device] = *other_devices.begin();
  return name + " was first the device " + devices.at(name) + ", then " + device +
         ": check the addresses of the drivers, and start again";
}

Reply Captured::measureLength(const square::TapedLength& taped, double placement) {
  if (!layout)
    return refusal(cameras.empty()
                       ? "no calibration is started: start one first"
                       : "this calibration has no square to measure: start one with a square");
  const std::size_t count = square.corners().size();
  if (taped.from >= count || taped.to >= count || taped.from == taped.to)
    return refusal(
        format("a length is between two captured corners, of which there are %zu, and not from %zu "
               "to %zu (in the service from 0 on): capture both, or name two others",
               count, taped.from + 1, taped.to + 1));
  const std::string name = format("corner %zu to corner %zu", taped.from + 1, taped.to + 1);
  const auto same = [&](const square::TapedLength& other) { return taped.hasCornersOf(other); };
  if (taped.length == 0.0) {
    const bool dropped = dropLengths(same, this);
    return {dropped, (dropped ? "the length from " : "there is no length from ") + name +
                         (dropped ? " was dropped: solve again" : " to drop")};
  }
  if (!(taped.length > 0.0 && std::isfinite(taped.length) && taped.stddev > 0.0 &&
        std::isfinite(taped.stddev)))
    return refusal("a length and its standard deviation must be above 0: give them in metres");
  const double by_sides = layout->lengthBetween(taped.from, taped.to);
  const double most = kMostDeviation * std::hypot(M_SQRT2 * placement, taped.stddev);
  if (std::abs(taped.length - by_sides) > most)
    return refusal(
        format("%s is %.3f m by the sides, at most %.0f mm more or less, but the tape "
               "says %.3f m: measure again, in metres, or start again with other sides",
               name.c_str(), by_sides, 1e3 * most, taped.length));
  dropLengths(same, this);
  layout->lengths.push_back(taped);
  ++latest_lengths;
  const double longer = taped.length - by_sides;
  return {true,
          format("%s is %.4f m by tape, %.1f mm %s than by the sides: solve again", name.c_str(),
                 taped.length, 1e3 * std::abs(longer), longer < 0.0 ? "less" : "more")};
}

void Captured::dropLengthsTo(std::size_t corner) {
  const auto ends_there = [&](const square::TapedLength& taped) {
    return taped.from == corner || taped.to == corner;
  };
  dropLengths(ends_there, this);
}

std::string Captured::whyNoPlace(const std::optional<geometry::Rig>& rig) const {
  if (!layout || !square.isComplete())
    return "a known place is solved together with a square: capture its four corners first";
  if (!rig || rig->id() != solved_to)
    return "the rig in use is not the solution of the captured corners: solve first or, if a "
           "camera was changed since they were captured, calibrate again to use known places";
  return "";
}

Reply Captured::addPlace(const square::KnownPlace& known, const capture::CapturedCorner& seen) {
  layout->places.push_back(known);
  places.push_back(seen);
  latest_lengths = 0;
  return {true, format("place %zu at (%.3f, %.3f, %.3f) m is captured by %zu cameras: solve again",
                       places.size(), known.position.x(), known.position.y(), known.position.z(),
                       seen.size())};
}

Reply Captured::undo() {
  if (latest_lengths > 0) {
    const square::TapedLength last = layout->lengths.back();
    return measureLength({last.from, last.to, 0.0}, 0.0);
  }
  if (!places.empty()) {
    places.pop_back();
    layout->places.pop_back();
    return {true, "the last known place was dropped: solve again"};
  }
  if (wave) {
    wave.reset();
    return {true, "the wave was dropped: record it again"};
  }
  const Reply reply = square.undo();
  if (reply.success)
    dropLengthsTo(square.corners().size());
  return reply;
}

Captured newRun(const std::vector<std::string>& cameras,
                const std::optional<square::SquareLayout>& layout,
                const capture::CornerCaptureOptions& capture,
                const std::string& world_frame) {
  const std::set<std::string> names(cameras.begin(), cameras.end());
  Captured captured;
  captured.cameras.assign(names.begin(), names.end());
  captured.layout = layout;
  captured.square = SquareRun(captured.cameras, capture);
  captured.world_frame = world_frame;
  return captured;
}

samples::Samples toSamples(const Captured& captured,
                           const CameraFacts& live,
                           const capture::Masks& masks) {
  const auto& facts = captured.restored_facts.empty() ? live : captured.restored_facts;
  samples::Samples samples;
  samples.world_frame = captured.world_frame;
  samples.recording.square = captured.layout;
  if (captured.wave)
    samples.recording.wand = captured.wave->wand();
  for (const std::string& name : captured.cameras) {
    samples.recording.cameras.push_back(recordingOf(captured, name, facts));
    if (const auto found = masks.find(name); found != masks.end())
      samples.recording.cameras.back().masks = found->second;
  }
  return samples;
}

Captured fromSamples(const samples::Samples& samples,
                     const capture::CornerCaptureOptions& capture,
                     const wave::CoverageOptions& coverage) {
  Captured captured;
  captured.layout = samples.recording.square;
  captured.world_frame = samples.world_frame;
  captured.wave = waveOf(samples.recording, coverage);
  std::vector<capture::CapturedCorner> corners;
  if (captured.layout)
    captured.places.resize(captured.layout->places.size());
  // The file does not hold how many images a corner is the mean of, and their spread.
  const auto view = [](const Eigen::Vector2d& pixel) {
    return capture::CornerView{pixel, std::numeric_limits<double>::quiet_NaN(), 1};
  };
  for (const wave::CameraRecording& camera : samples.recording.cameras) {
    const square::CameraSightings& seen = camera.sightings;
    captured.cameras.push_back(seen.name);
    if (!seen.identity.empty())
      captured.devices[seen.name] = seen.identity;
    captured.restored_facts[seen.name] = {seen.name, seen.identity, seen.intrinsics, {},
                                          {},        seen.gravity};
    for (std::size_t c = 0; c < seen.corners.size(); ++c) {
      if (!seen.corners[c])
        continue;
      corners.resize(std::max(corners.size(), c + 1));
      corners[c][seen.name] = view(*seen.corners[c]);
    }
    for (std::size_t p = 0; p < seen.places.size(); ++p) {
      if (seen.places[p])
        captured.places.at(p)[seen.name] = view(*seen.places[p]);
    }
  }
  captured.square = SquareRun(captured.cameras, capture);
  captured.square.restore(corners);
  return captured;
}

}  // namespace wiimote_tracker::workflow
