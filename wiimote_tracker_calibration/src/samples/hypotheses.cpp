#include "hypotheses.h"

#include "clock_lag.h"
#include "square/planar_pose.h"

#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Geometry>

#include <cmath>
#include <utility>

namespace wiimote_tracker::samples {

namespace {

// Factor on the misfit without a camera, which leaves out much of the data.
constexpr double kWithoutCamera = 1.3;
// Smallest errors that are looked for: of a side, relative, and of a clock [s].
constexpr double kLeastSide = 0.02;
constexpr double kLeastLag = 0.05;
// Of more cameras not all pairs are exchanged: there would be too many.
constexpr std::size_t kMostForPairs = 6;

const std::string& nameOf(const Hypothesis& as_is, std::size_t camera) {
  return as_is.recording.cameras[camera].sightings.name;
}

/// Adds the recording as it is, to be changed.
template <typename Describe>
Hypothesis& add(const Hypothesis& as_is, Hypotheses* all, Describe describe) {
  all->push_back(as_is);
  all->back().describe = std::move(describe);
  return all->back();
}

void addCorners(const Hypothesis& as_is, Hypotheses* all) {
  for (std::size_t c = 0; c < 4; ++c) {
    Hypothesis& elsewhere = add(as_is, all, [c](const square::Solution& found) {
      return format(
          "corner %zu was captured %.0f mm from its place: put the LED there, capture "
          "corner %zu again and solve",
          c + 1, 1e3 * found.corner_offsets[c].norm(), c + 1);
    });
    elsewhere.uncertainty.unknown_corner = c;
  }
}

/// Each of the lengths that were taped is wrong.
void addTapedLengths(const Hypothesis& as_is, Hypotheses* all) {
  const square::SquareLayout& layout = *as_is.recording.square;
  for (std::size_t i = 0; i < layout.lengths.size(); ++i) {
    Hypothesis& without = add(as_is, all, [layout, i](const square::Solution& found) {
      const square::TapedLength& taped = layout.lengths[i];
      const square::Corners places = layout.corners(found.z_up);
      const double length = (places[taped.to] + found.corner_offsets[taped.to] -
                             places[taped.from] - found.corner_offsets[taped.from])
                                .norm();
      return format(
          "the length from corner %zu to corner %zu is %.3f m by all else, not "
          "%.3f m: measure it again",
          taped.from + 1, taped.to + 1, length, taped.length);
    });
    std::vector<square::TapedLength>& lengths = without.recording.square->lengths;
    lengths.erase(lengths.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Other sides, in the ratio of free corners, and another length of the wand.
void addSidesAndWand(const Hypothesis& as_is,
                     const std::optional<square::Solution>& free,
                     Hypotheses* all) {
  const square::SquareLayout layout = *as_is.recording.square;
  square::Corners at = layout.corners(!free || free->z_up);
  for (std::size_t c = 0; c < 4 && free; ++c)
    at[c] += free->corner_offsets[c];
  const double ratio = ((at[2] - at[1]).norm() + (at[3] - at[0]).norm()) /
                       ((at[1] - at[0]).norm() + (at[3] - at[2]).norm());
  const double side_y = layout.side_x * ratio;
  if (std::abs(std::log(side_y / layout.side_y)) > kLeastSide) {
    Hypothesis& other_sides = add(as_is, all, [=](const square::Solution&) {
      return format(
          "the sides of the square are not %.3g m and %.3g m: the second would be "
          "%.3g m, or the first %.3g m; measure both, and start again with them",
          layout.side_x, layout.side_y, side_y, layout.side_y / ratio);
    });
    other_sides.recording.square->side_y = side_y;
  }
  if (!as_is.recording.wand || !as_is.recording.hasFrames())
    return;
  const double length = as_is.recording.wand->length;
  Hypothesis& other_wand = add(as_is, all, [=](const square::Solution& found) {
    const double scale = length / found.wave->wand_length;
    return format(
        "the wand and the square contradict each other: by the square the wand is %.4g m "
        "long, not %.4g m, or by the wand the sides are %.3g m and %.3g m; measure them "
        "again",
        found.wave->wand_length, length, scale * layout.side_x, scale * layout.side_y);
  });
  other_wand.recording.wand->stddev = length;
}

void addGravity(const Hypothesis& as_is, std::size_t i, Hypotheses* all) {
  if (!as_is.recording.cameras[i].sightings.gravity)
    return;
  Hypothesis& without =
      add(as_is, all, [seen = as_is.recording.cameras[i].sightings](const square::Solution& found) {
        const geometry::RigCamera* camera = found.rig.find(seen.name);
        const auto tilt =
            camera ? seen.tilt(camera->camera.world_from_camera, found.z_up) : std::nullopt;
        return format(
            "the accelerometer of %s contradicts all images by %.0f degrees: its axes or its "
            "image are turned; correct that, or do not use gravity",
            seen.name.c_str(), tilt.value_or(0.0) * 180.0 / M_PI);
      });
  without.recording.cameras[i].sightings.gravity.reset();
}

void addWaveMistakes(const Hypothesis& as_is, std::size_t i, Hypotheses* all) {
  const wave::Recording& recording = as_is.recording;
  const std::string& name = nameOf(as_is, i);
  const double lag = clockLag(recording, i).value_or(0.0);
  if (std::abs(lag) > kLeastLag) {
    Hypothesis& clock = add(as_is, all, [=](const square::Solution& found) {
      const double ahead = lag - found.rig.find(name)->time_offset;
      return format(
          "the clock of %s is %.2f s %s the others: check the time of its computer and "
          "its driver, and wave again",
          name.c_str(), std::abs(ahead), ahead > 0.0 ? "ahead of" : "behind");
    });
    for (wave::Frame& frame : clock.recording.cameras[i].frames)
      frame.stamp -= lag;
  }
  Hypothesis& mirrored = add(as_is, all, [=](const square::Solution&) {
    return "the image of " + name +
           " is mirrored: make its x run to the right and its y down, and wave again";
  });
  for (wave::Frame& frame : mirrored.recording.cameras[i].frames) {
    for (Eigen::Vector2d& spot : frame.spots)
      spot.x() = recording.cameras[i].sightings.intrinsics.width - 1.0 - spot.x();
  }
  const std::size_t count = recording.cameras.size();
  for (std::size_t j = i + 1; j < count && count <= kMostForPairs && recording.square; ++j) {
    Hypothesis& exchanged = add(as_is, all, [=, other = nameOf(as_is, j)](const square::Solution&) {
      return name + " and " + other +
             " were exchanged between the corners and the wave: check the "
             "addresses of their drivers, and start again";
    });
    std::swap(exchanged.recording.cameras[i].frames, exchanged.recording.cameras[j].frames);
  }
}

}  // namespace

Hypotheses likelyMistakes(const Hypothesis& as_is, const std::optional<square::Solution>& free) {
  Hypotheses all;
  if (as_is.recording.square) {
    addCorners(as_is, &all);
    addTapedLengths(as_is, &all);
    addSidesAndWand(as_is, free, &all);
  }
  for (std::size_t i = 0; i < as_is.recording.cameras.size(); ++i) {
    addGravity(as_is, i, &all);
    if (as_is.recording.hasFrames())
      addWaveMistakes(as_is, i, &all);
  }
  return all;
}

Hypotheses movedCameras(const Hypothesis& as_is) {
  Hypotheses all;
  if (!as_is.recording.square || !as_is.recording.hasFrames())
    return all;
  for (std::size_t i = 0; i < as_is.recording.cameras.size(); ++i) {
    const square::CameraSightings& sightings = as_is.recording.cameras[i].sightings;
    Hypothesis& without = add(
        as_is, &all,
        [seen = sightings, layout = *as_is.recording.square](const square::Solution& found) {
          const geometry::Camera& solved = found.rig.find(seen.name)->camera;
          const auto poses =
              square::cornerPoses(solved.intrinsics, seen.corners, layout.corners(found.z_up));
          std::string how_far;
          if (!poses.empty()) {
            const Eigen::Isometry3d moved =
                poses.front().world_from_camera.inverse() * solved.world_from_camera;
            how_far = format(" by %.0f mm and %.1f degrees", 1e3 * moved.translation().norm(),
                             Eigen::AngleAxisd(moved.linear()).angle() * 180.0 / M_PI);
          }
          return seen.name + " moved" + how_far +
                 " between the corners and the wave, or its spots at the corners were not the LED: "
                 "fix it, and start again";
        });
    without.recording.cameras[i].sightings.corners = {};
  }
  return all;
}

Hypotheses wrongCameras(const Hypothesis& as_is) {
  Hypotheses all;
  const std::size_t count = as_is.recording.cameras.size();
  for (std::size_t i = 0; i < count && count > 2; ++i) {
    Hypothesis& without = add(as_is, &all, [name = nameOf(as_is, i)](const square::Solution&) {
      return name +
             " alone contradicts the others: check that it did not move and that its spot "
             "was the LED, and its starting intrinsics; then capture all again";
    });
    without.factor = kWithoutCamera;
    without.recording.cameras.erase(without.recording.cameras.begin() +
                                    static_cast<std::ptrdiff_t>(i));
  }
  return all;
}

}  // namespace wiimote_tracker::samples
