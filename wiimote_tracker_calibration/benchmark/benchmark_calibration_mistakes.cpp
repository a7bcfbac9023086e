// Mistakes of a person who calibrates: what was done, and what the calibration says.
#include "benchmark_calibration_sections.h"
#include "samples/solve_samples.h"
#include "wave_trial.h"

#include <wiimote_tracker_triangulation/geometry/calibration_uncertainty.h>
#include <wiimote_tracker_triangulation/geometry/error.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

using Words = std::vector<std::string>;

/// A recording that a mistake changes.
struct Spoilt {
  wave::WaveScene scene;
  std::uint64_t seed;
  wave::SimulatedWave wave;

  std::vector<wave::CameraRecording>& cameras() { return wave.recording.cameras; }
  square::SquareLayout& square() { return *wave.recording.square; }

  /// The images of a camera from which another one is turned by 3.4 degrees.
  std::vector<wave::Frame> framesOfTurned(std::size_t camera) const {
    wave::WaveScene turned = scene;
    turned.cameras = scene.poses();
    turned.cameras.resize(scene.camera_count);
    turned.cameras[camera].linear() *=
        Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitY()).toRotationMatrix();
    return wave::simulateWave(turned, seed).recording.cameras[camera].frames;
  }
};

std::string cameraName(std::size_t camera) {
  return "camera_" + std::to_string(camera + 1);
}

/// @param which camera or corner. @returns what must be said.
using Make = std::function<Words(Spoilt* recording, std::size_t which)>;

/// The LED lay this far from a corner [m].
Make displaceCorner(double distance) {
  return [=](Spoilt* it, std::size_t corner) -> Words {
    const Eigen::Vector3d place =
        it->wave.corners[corner] + distance * Eigen::Vector3d(0.8, -0.6, 0.0);
    for (std::size_t i = 0; i < it->cameras().size(); ++i)
      it->cameras()[i].sightings.corners[corner] = *it->wave.cameras[i].project(place);
    return {"corner " + std::to_string(corner + 1)};
  };
}

/// Some time after the first image [s].
Make moveClock(double by, double since) {
  return [=](Spoilt* it, std::size_t camera) -> Words {
    std::vector<wave::Frame>& frames = it->cameras()[camera].frames;
    const double start = frames.front().stamp + since;
    for (wave::Frame& frame : frames)
      frame.stamp += frame.stamp >= start ? by : 0.0;
    return {"the clock of " + cameraName(camera)};
  };
}

Make stateSides(double x, double y, const char* word) {
  return [=](Spoilt* it, std::size_t) -> Words {
    it->square().side_x = x;
    it->square().side_y = y;
    return {word};
  };
}

Make stateWand(double length) {
  return [=](Spoilt* it, std::size_t) -> Words {
    it->wave.recording.wand->length = length;
    return {"by the square the wand is 0."};
  };
}

Words captureClockwise(Spoilt* it, std::size_t /*any*/) {
  for (wave::CameraRecording& camera : it->cameras())
    std::swap(camera.sightings.corners[1], camera.sightings.corners[3]);
  return {"clockwise"};
}

Words turnGravity(Spoilt* it, std::size_t camera) {
  Eigen::Vector3d& gravity = *it->cameras()[camera].sightings.gravity;
  gravity = Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitZ()) * gravity;
  return {"the accelerometer of " + cameraName(camera)};
}

Words knockBetweenCorners(Spoilt* it, std::size_t camera) {
  for (std::size_t corner = 1; corner < 4; ++corner)
    *it->cameras()[camera].sightings.corners[corner] += Eigen::Vector2d(60.0, 25.0);
  return {cameraName(camera)};
}

Words moveAfterTheCorners(Spoilt* it, std::size_t camera) {
  it->cameras()[camera].frames = it->framesOfTurned(camera);
  return {cameraName(camera), "moved"};
}

Words moveInTheWave(Spoilt* it, std::size_t camera) {
  std::vector<wave::Frame>& frames = it->cameras()[camera].frames;
  const std::vector<wave::Frame> turned = it->framesOfTurned(camera);
  for (std::size_t i = frames.size() / 2; i < std::min(frames.size(), turned.size()); ++i)
    frames[i] = turned[i];
  return {cameraName(camera)};
}

Words mirror(Spoilt* it, std::size_t camera) {
  for (wave::Frame& frame : it->cameras()[camera].frames) {
    for (Eigen::Vector2d& spot : frame.spots)
      spot.x() = 1023.0 - spot.x();
  }
  return {"the image of " + cameraName(camera) + " is mirrored"};
}

Words exchange(Spoilt* it, std::size_t camera) {
  const std::size_t other = (camera + 1) % it->cameras().size();
  std::swap(it->cameras()[camera].frames, it->cameras()[other].frames);
  return {cameraName(camera), cameraName(other), "exchanged"};
}

Words tapeWrongly(Spoilt* it, std::size_t /*any*/) {
  const square::Corners& corners = it->wave.corners;
  it->square().lengths = {{0, 1, (corners[1] - corners[0]).norm()},
                          {0, 2, (corners[2] - corners[0]).norm() + 0.06}};
  return {"the length from corner 1 to corner 3"};
}

struct Mistake {
  const char* done;
  bool waved;
  double wand;  ///< Length [m]; 0: none.
  Make make;
};

std::vector<Mistake> allMistakes() {
  return {
      {"corner 20 cm off", false, 0.0, displaceCorner(0.2)},
      {"camera knocked between the corners", false, 0.0, knockBetweenCorners},
      {"second side 2 m instead of 2.5", false, 0.0, stateSides(2.5, 2.0, "sides of the square")},
      {"accelerometer's axes turned", false, 0.0, turnGravity},
      {"corners clockwise", false, 0.0, captureClockwise},
      {"corner 20 cm off, wave", true, 0.0, displaceCorner(0.2)},
      {"corner 5 cm off, wave", true, 0.0, displaceCorner(0.05)},
      {"camera turned after the corners", true, 0.0, moveAfterTheCorners},
      {"camera turned in the wave", true, 0.0, moveInTheWave},
      {"clock 1 s ahead", true, 0.0, moveClock(1.0, 0.0)},
      {"clock 0.3 s behind", true, 0.0, moveClock(-0.3, 0.0)},
      {"clock that jumps by 20 ms", true, 0.0, moveClock(0.02, 2.0)},
      {"wand of 0.5 m stated as 0.6 m", true, 0.5, stateWand(0.6)},
      {"wand of 0.5 m stated as 0.45 m", true, 0.5, stateWand(0.45)},
      {"diagonal measured 6 cm too long", true, 0.0, tapeWrongly},
      {"drivers exchanged after the corners", true, 0.0, exchange},
      {"image mirrored in the wave", true, 0.0, mirror},
      {"sides in centimetres, wave", true, 0.0, stateSides(250.0, 250.0, "is the square really")},
      {"sides in centimetres", false, 0.0, stateSides(250.0, 250.0, "is the square really")},
      {"corners clockwise, wave", true, 0.0, captureClockwise},
  };
}

Spoilt recordingFor(const Mistake& mistake, std::uint64_t seed) {
  wave::WaveScene scene;
  scene.duration = 5.0;
  scene.rate = 50.0;
  scene.length = mistake.wand;
  Spoilt result{scene, seed, wave::simulateWave(scene, seed)};
  for (std::size_t i = 0; i < result.cameras().size(); ++i) {
    wave::CameraRecording& camera = result.cameras()[i];
    const Eigen::Isometry3d& stands = result.wave.cameras[i].world_from_camera;
    camera.sightings.gravity = stands.linear().transpose() * Eigen::Vector3d(0.0, 0.0, 9.81);
    if (!mistake.waved)
      camera.frames.clear();
  }
  return result;
}

/// Largest error of a point of the cube, in standard deviations as stated.
double largestDeviation(const std::vector<geometry::Camera>& truth, const geometry::Rig& rig) {
  const std::vector<Eigen::Vector3d> points = wave::cubePoints(truth);
  std::vector<std::size_t> all(rig.cameras.size());
  std::iota(all.begin(), all.end(), 0);
  const geometry::CalibrationUncertainty uncertainty(rig);
  const Eigen::Matrix3Xd errors = wave::pointErrors(truth, wave::camerasOf(rig.cameras), points);
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const auto covariance = uncertainty.covarianceOf(points[i], all.data(), all.size()))
      worst = std::max(
          worst, errors.col(static_cast<Eigen::Index>(i)).norm() / std::sqrt(covariance->trace()));
  }
  return worst;
}

BenchmarkRow rowOf(const Mistake& mistake, int runs) {
  int named = 0;
  int silent = 0;  // accepted, not named, and points are off
  std::string said;
  for (int run = 0; run < runs; ++run) {
    Spoilt spoilt = recordingFor(mistake, static_cast<std::uint64_t>(4 + run));
    const Words words = mistake.make(&spoilt, static_cast<std::size_t>(run) % 4);
    samples::Samples samples;
    samples.recording = spoilt.wave.recording;
    samples.masks.resize(spoilt.cameras().size());
    samples::SolveOptions options;
    options.wave = wave::optionsFor(spoilt.scene);
    options.square.uncertainty = spoilt.scene.uncertainty;
    double deviation = 0.0;
    std::string text;
    try {
      const geometry::Rig rig = samples::solveSamples(samples, options).rig;
      text = rig.verdict;
      deviation = largestDeviation(spoilt.wave.cameras, rig);
    } catch (const geometry::Error& error) {
      text = error.what();
    }
    const bool is_named = std::all_of(words.begin(), words.end(), [&](const std::string& word) {
      return text.find(word) != std::string::npos;
    });
    named += is_named ? 1 : 0;
    silent += !is_named && deviation > 3.0 ? 1 : 0;
    if (said.empty() || !is_named)
      said = text;  // the first, or the last that does not name it
  }
  return {mistake.done, {{"tried", runs}, {"named", named}, {"silent", silent}}, said};
}

}  // namespace

BenchmarkSection mistakesSection() {
  return {"mistakes",
          "four cameras of the paper's rig; a mistake with another camera or corner each time. How "
          "often it was named, how often neither named nor harmless (a point is off by more than "
          "three stated deviations), and what was said the first time, or where it was not named.",
          [](int runs, const RowCallback& row) {
            for (const Mistake& mistake : allMistakes())
              row(rowOf(mistake, runs));
          }};
}

}  // namespace wiimote_tracker
