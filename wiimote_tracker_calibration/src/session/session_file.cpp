#include "session/session_file.h"

#include "frame_lines.h"
#include "session_yaml.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/atomic_file.h>
#include <wiimote_tracker_triangulation/geometry/error.h>

#include <cmath>
#include <limits>
#include <set>

namespace wiimote_tracker::session {

namespace {

// Ten minutes of 64 cameras, of which each number has 17 digits [bytes].
constexpr std::size_t kLargestFile = 300000000;
// Between the two YAML documents of the file.
constexpr const char* kFramesLine =
    "--- # Images of the wave, camera by camera: time [s], then x and y [px] of every spot.";
// Before the frames of each camera.
constexpr const char* kCameraLine = "- |";
// The last line: a file that was cut off lacks it.
constexpr const char* kEndLine = "...";

void require(bool condition, const std::string& what) {
  if (!condition)
    throw Error(what + "; correct it or capture again");
}

void checkCamera(const wave::CameraRecording& camera,
                 const std::vector<geometry::ImageMask>& masks) {
  const square::CameraSightings& sightings = camera.sightings;
  const std::string& name = sightings.name;
  sightings.intrinsics.check();
  for (const auto& corner : sightings.corners)
    require(!corner || corner->allFinite(), "a corner that " + name + " saw is not finite");
  for (const auto& place : sightings.places)
    require(!place || place->allFinite(), "a place that " + name + " saw is not finite");
  require(!sightings.gravity || sightings.gravity->allFinite(),
          "the gravity of " + name + " is not finite");
  for (const geometry::ImageMask& mask : masks)
    require(mask.center.allFinite() && std::isfinite(mask.radius) && mask.radius > 0.0,
            "a mask of " + name + " is not finite or its radius not above 0");
  double before = -std::numeric_limits<double>::infinity();
  for (const wave::Frame& frame : camera.frames) {
    require(std::isfinite(frame.stamp), "the time of an image of " + name + " is not finite");
    require(frame.stamp > before, "the images of " + name + " are not in the order of their times");
    before = frame.stamp;
    for (const Eigen::Vector2d& spot : frame.spots)
      require(spot.allFinite(), "a spot of " + name + " is not finite");
  }
}

/// Checks what readSessionFile() requires.
void check(const Session& session) {
  const wave::Recording& recording = session.recording;
  require(!session.world_frame.empty(), "the world frame has no name");
  if (recording.square)
    recording.square->check();
  if (recording.wand)
    recording.wand->check();
  require(session.masks.size() == recording.cameras.size(),
          "the masks are not of as many cameras as were captured");
  std::set<std::string> names;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    const std::string& name = recording.cameras[i].sightings.name;
    require(!name.empty(), "a camera has no name");
    require(names.insert(name).second, "two cameras are called " + name);
    checkCamera(recording.cameras[i], session.masks[i]);
    require(recording.cameras[i].sightings.places.size() ==
                (recording.square ? recording.square->places.size() : 0),
            "the known places are not as many as " + name + " has pixels for");
  }
}

}  // namespace

void writeSessionFile(const Session& session, const std::string& path) {
  check(session);
  std::string text = yamlFromSession(session);
  text += std::string("\n") + kFramesLine + "\n";
  for (const wave::CameraRecording& camera : session.recording.cameras) {
    text += std::string(kCameraLine) + "\n";
    appendFrames(camera.frames, &text);
  }
  text += std::string(kEndLine) + "\n";
  if (text.size() > kLargestFile)
    throw Error(format(
        "what was captured fills %.0f MB, but a samples file has %.0f MB at most: record the "
        "wave again, for a shorter time",
        1e-6 * static_cast<double>(text.size()), 1e-6 * static_cast<double>(kLargestFile)));
  geometry::writeFileAtomically(path, text);
}

Session readSessionFile(const std::string& path) {
  const std::string text = geometry::readFile(path, kLargestFile);
  const std::size_t head_end = text.find(std::string("\n") + kFramesLine + "\n");
  if (head_end == std::string::npos)
    throw Error(path +
                " is cut off, or holds no samples of a calibration; restore it from its "
                "backup, or choose a file that save_samples wrote");
  SessionHead head = headFromYaml(text.substr(0, head_end + 1), path);
  Lines lines(text, head_end + 1, path);
  lines.expect(kFramesLine);
  for (std::size_t i = 0; i < head.frames.size(); ++i) {
    lines.expect(kCameraLine);
    head.session.recording.cameras[i].frames = lines.frames(head.frames[i]);
  }
  lines.expect(kEndLine);
  lines.expectEnd();
  try {
    check(head.session);
  } catch (const geometry::Error& error) {
    throw Error(path + ": " + error.what());
  }
  return head.session;
}

}  // namespace wiimote_tracker::session
