#include "workflow/captured.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker::workflow {

namespace {

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
  std::vector<geometry::Camera> cameras;
  double first = std::numeric_limits<double>::infinity();
  for (const wave::CameraRecording& camera : recording.cameras) {
    cameras.push_back(camera.sightings.camera());
    if (!camera.frames.empty())
      first = std::min(first, camera.frames.front().stamp);
  }
  if (first == std::numeric_limits<double>::infinity())
    return std::nullopt;
  WaveRecorder wave(cameras, false, recording.wand, options, first);
  for (const wave::CameraRecording& camera : recording.cameras) {
    for (const wave::Frame& frame : camera.frames)
      wave.add({camera.sightings.name, frame.stamp, camera.clock_epoch, frame.spots, {}});
  }
  return wave;
}

}  // namespace

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

session::Session toSession(const Captured& captured,
                           const CameraFacts& live,
                           const capture::Masks& masks) {
  const auto& facts = captured.restored_facts.empty() ? live : captured.restored_facts;
  session::Session session;
  session.world_frame = captured.world_frame;
  session.recording.square = captured.layout;
  if (captured.wave)
    session.recording.wand = captured.wave->wand();
  for (const std::string& name : captured.cameras) {
    session.recording.cameras.push_back(recordingOf(captured, name, facts));
    const auto mask = masks.find(name);
    session.masks.push_back(mask != masks.end() ? mask->second
                                                : std::vector<geometry::ImageMask>());
  }
  return session;
}

Captured fromSession(const session::Session& session,
                     const capture::CornerCaptureOptions& capture,
                     const wave::CoverageOptions& coverage) {
  Captured captured;
  captured.layout = session.recording.square;
  captured.world_frame = session.world_frame;
  captured.wave = waveOf(session.recording, coverage);
  std::vector<capture::CapturedCorner> corners;
  if (captured.layout)
    captured.places.resize(captured.layout->places.size());
  // The file does not hold the number of samples and their spread.
  const auto view = [](const Eigen::Vector2d& pixel) {
    return capture::CornerView{pixel, std::numeric_limits<double>::quiet_NaN(), 1};
  };
  for (const wave::CameraRecording& camera : session.recording.cameras) {
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
