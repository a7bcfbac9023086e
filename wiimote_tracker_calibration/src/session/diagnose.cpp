#include "diagnose.h"

#include "clock_lag.h"
#include "judge.h"
#include "square/planar_pose.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace wiimote_tracker::session {

namespace {

// A hypothesis with a smaller misfit is taken, without others that leave out more of the data.
constexpr double kGood = 1.2;
// Factor on the misfit without a camera, which leaves out much of the data.
constexpr double kWithoutCamera = 1.3;
// Hypotheses whose misfits differ by less than this ratio are both named.
constexpr double kAlike = 1.2;
// Smallest errors that are looked for: of a side, relative, and of a clock [s].
constexpr double kLeastSide = 0.02;
constexpr double kLeastLag = 0.05;
// Of more cameras not all pairs are exchanged: there would be too many.
constexpr std::size_t kMostForPairs = 6;

/// A recording that could be solved.
struct Attempt {
  geometry::Rig rig;
  double misfit = 0.0;
  bool contradicts = false;
  bool z_up = true;
  square::Corners corner_offsets{};
  double wand_length = 0.0;
};

struct Hypothesis {
  wave::Recording recording;
  square::Uncertainty uncertainty;
  std::function<std::string(const Attempt&)> describe;
  double factor = 1.0;  // on the misfit
};

class Diagnosis {
 public:
  Diagnosis(const wave::Recording& recording,
            const SolveOptions& options,
            const wave::ProgressCallback& progress)
      : recording_(recording), options_(options), progress_(progress) {
    // Half of many images tell as much.
    for (wave::CameraRecording& camera : recording_.cameras) {
      const std::size_t stride = camera.frames.size() / 500 > 0 ? 2 : 1;
      std::vector<wave::Frame> frames;
      for (std::size_t i = 0; i < camera.frames.size(); i += stride)
        frames.push_back(camera.frames[i]);
      camera.frames = std::move(frames);
    }
  }

  std::optional<Mistake> run(bool contradicts) {
    const std::string question = scaleOfSquare();
    if (!question.empty())
      return Mistake{question, std::nullopt};
    if (!contradicts)
      return std::nullopt;
    if (recording_.square) {
      addCorners();
      addSides();
    }
    addGravity();
    if (recording_.hasFrames())
      addWaveMistakes();
    if (solveAll())
      return best();
    if (recording_.square && recording_.hasFrames()) {
      for (std::size_t i = 0; i < recording_.cameras.size(); ++i)
        addMovedAfterCorners(i);
      if (solveAll())
        return best();
    }
    for (std::size_t i = 0; i < recording_.cameras.size() && recording_.cameras.size() > 2; ++i)
      addWithout(i);
    solveAll();
    return best();
  }

 private:
  const std::string& name(std::size_t camera) const {
    return recording_.cameras[camera].sightings.name;
  }

  /// A hypothesis with the recording as it is, to be changed.
  Hypothesis& add(std::function<std::string(const Attempt&)> describe) {
    hypotheses_.push_back({recording_, options_.square.uncertainty, std::move(describe)});
    return hypotheses_.back();
  }

  /// scaleQuestion() of the square alone: a wave does not fit a wrong scale.
  std::string scaleOfSquare() {
    if (!recording_.square || !recording_.hasFrames())
      return "";
    wave::Recording corners = recording_;
    for (wave::CameraRecording& camera : corners.cameras)
      camera.frames.clear();
    const auto attempt = solve(corners, options_.square.uncertainty);
    if (!attempt)
      return "";
    const square::Corners led = recording_.square->corners(attempt->z_up);
    return scaleQuestion(recording_, attempt->rig, {led.begin(), led.end()});
  }

  void addCorners() {
    for (std::size_t c = 0; c < 4; ++c)
      add([c](const Attempt& attempt) {
        return format(
            "corner %zu was captured %.0f mm from its place: put the LED there, capture "
            "corner %zu again and solve",
            c + 1, 1e3 * attempt.corner_offsets[c].norm(), c + 1);
      }).uncertainty.unknown_corner = c;
  }

  /// The ratio of the sides by free corners, and the scale by the wand.
  void addSides() {
    const square::SquareLayout& layout = *recording_.square;
    square::Uncertainty free = options_.square.uncertainty;
    free.placement = 0.1 * std::min(layout.side_x, layout.side_y);
    if (const auto attempt = solve(recording_, free)) {
      square::Corners at = layout.corners(attempt->z_up);
      for (std::size_t c = 0; c < 4; ++c)
        at[c] += attempt->corner_offsets[c];
      const double ratio = ((at[2] - at[1]).norm() + (at[3] - at[0]).norm()) /
                           ((at[1] - at[0]).norm() + (at[3] - at[2]).norm());
      const double side_y = layout.side_x * ratio;
      if (std::abs(std::log(side_y / layout.side_y)) > kLeastSide) {
        const double side_x = layout.side_y / ratio;
        add([=](const Attempt&) {
          return format(
              "the sides of the square are not %.3g m and %.3g m: the second would be "
              "%.3g m, or the first %.3g m; measure both, and start again with them",
              layout.side_x, layout.side_y, side_y, side_x);
        }).recording.square->side_y = side_y;
      }
    }
    if (recording_.wand) {
      const double length = recording_.wand->length;
      add([=](const Attempt& attempt) {
        const double scale = length / attempt.wand_length;
        return format(
            "the wand and the square contradict each other: by the square the wand is "
            "%.4g m long, not %.4g m, or by the wand the sides are %.3g m and %.3g m; "
            "measure them again",
            attempt.wand_length, length, scale * layout.side_x, scale * layout.side_y);
      }).recording.wand->stddev = length;
    }
  }

  void addGravity() {
    for (std::size_t i = 0; i < recording_.cameras.size(); ++i) {
      const auto gravity = recording_.cameras[i].sightings.gravity;
      if (!gravity)
        continue;
      add([this, i, gravity](const Attempt& attempt) {
        const geometry::RigCamera* camera = attempt.rig.find(name(i));
        const Eigen::Vector3d up(0.0, 0.0, attempt.z_up ? 1.0 : -1.0);
        const Eigen::Vector3d measured =
            camera ? camera->camera.world_from_camera.linear() * gravity->normalized() : up;
        return format(
            "the accelerometer of %s contradicts all images by %.0f degrees: its axes "
            "or its image are turned; correct that, or do not use gravity",
            name(i).c_str(),
            std::atan2(up.cross(measured).norm(), up.dot(measured)) * 180.0 / M_PI);
      })
          .recording.cameras[i]
          .sightings.gravity.reset();
    }
  }

  void addWaveMistakes() {
    const std::size_t count = recording_.cameras.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double lag = clockLag(recording_, i).value_or(0.0);
      if (std::abs(lag) > kLeastLag) {
        Hypothesis& clock = add([this, i, lag](const Attempt& attempt) {
          const double ahead = lag - attempt.rig.find(name(i))->time_offset;
          return format(
              "the clock of %s is %.2f s %s the others: check the time of its computer and its "
              "driver, and wave again",
              name(i).c_str(), std::abs(ahead), ahead > 0.0 ? "ahead of" : "behind");
        });
        for (wave::Frame& frame : clock.recording.cameras[i].frames)
          frame.stamp -= lag;
      }
      Hypothesis& mirrored = add([this, i](const Attempt&) {
        return "the image of " + name(i) +
               " is mirrored: make its x run to the right and its y down, and wave again";
      });
      const double width = recording_.cameras[i].sightings.intrinsics.width;
      for (wave::Frame& frame : mirrored.recording.cameras[i].frames) {
        for (Eigen::Vector2d& spot : frame.spots)
          spot.x() = width - 1.0 - spot.x();
      }
      for (std::size_t j = i + 1; j < count && count <= kMostForPairs && recording_.square; ++j) {
        std::vector<wave::CameraRecording>& cameras =
            add([this, i, j](const Attempt&) {
              return name(i) + " and " + name(j) +
                     " were exchanged between the corners and the wave: check the addresses of "
                     "their "
                     "drivers, and start again";
            }).recording.cameras;
        std::swap(cameras[i].frames, cameras[j].frames);
      }
    }
  }

  void addMovedAfterCorners(std::size_t i) {
    add([this, i](const Attempt& attempt) {
      std::string how_far;
      const geometry::RigCamera* solved = attempt.rig.find(name(i));
      const auto poses = solved ? square::cornerPoses(solved->camera.intrinsics,
                                                      recording_.cameras[i].sightings.corners,
                                                      recording_.square->corners(attempt.z_up))
                                : std::vector<square::PlanarPose>();
      if (!poses.empty()) {
        const Eigen::Isometry3d moved =
            poses.front().world_from_camera.inverse() * solved->camera.world_from_camera;
        how_far = format(" by %.0f mm and %.1f degrees", 1e3 * moved.translation().norm(),
                         Eigen::AngleAxisd(moved.linear()).angle() * 180.0 / M_PI);
      }
      return name(i) + " moved" + how_far +
             " between the corners and the wave, or its spots at the corners were not the LED: fix "
             "it, and start again";
    })
        .recording.cameras[i]
        .sightings.corners = {};
  }

  void addWithout(std::size_t i) {
    Hypothesis& without = add([this, i](const Attempt&) {
      return name(i) +
             " alone contradicts the others: check that it did not move and that its spot was the "
             "LED, and its starting intrinsics";
    });
    without.factor = kWithoutCamera;
    std::vector<wave::CameraRecording>& cameras = without.recording.cameras;
    cameras.erase(cameras.begin() + static_cast<std::ptrdiff_t>(i));
  }

  /// Solves the hypotheses so far. @returns whether one of them explains the data well.
  bool solveAll() {
    for (const Hypothesis& hypothesis : std::exchange(hypotheses_, {})) {
      const auto attempt = solve(hypothesis.recording, hypothesis.uncertainty);
      if (attempt && !attempt->contradicts)
        causes_.emplace_back(
            hypothesis.factor * attempt->misfit,
            Mistake{hypothesis.describe(*attempt), hypothesis.uncertainty.unknown_corner});
    }
    std::sort(causes_.begin(), causes_.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    return !causes_.empty() && causes_.front().first < kGood;
  }

  std::optional<Mistake> best() const {
    if (causes_.empty())
      return std::nullopt;
    Mistake mistake = causes_[0].second;
    if (causes_.size() > 1 && causes_[1].first < kAlike * causes_[0].first)
      mistake.text += "; or " + causes_[1].second.text;
    return mistake;
  }

  std::optional<Attempt> solve(const wave::Recording& recording,
                               const square::Uncertainty& uncertainty) {
    if (progress_ && !progress_({"looking for the mistake", 1.0}))
      throw wave::Cancelled("the calibration was cancelled: nothing was changed");
    try {
      if (recording.hasFrames()) {
        wave::WaveOptions options = options_.wave;
        options.uncertainty = uncertainty;
        wave::WaveSolution solution = wave::solveWave(recording, options);
        return Attempt{std::move(solution.rig), solution.misfit,         solution.contradicts,
                       solution.z_up,           solution.corner_offsets, solution.wand_length};
      }
      square::SolveOptions options = options_.square;
      options.method = square::Method::kJoint;
      options.uncertainty = uncertainty;
      square::SquareSolution solution =
          square::solveSquare(*recording.square, recording.sightings(), options);
      return Attempt{std::move(solution.rig), solution.misfit, solution.contradicts, solution.z_up,
                     solution.corner_offsets};
    } catch (const geometry::Error&) {
      return std::nullopt;
    }
  }

  wave::Recording recording_;
  const SolveOptions& options_;
  const wave::ProgressCallback& progress_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<std::pair<double, Mistake>> causes_;  // with their misfits, the best first
};

}  // namespace

std::optional<Mistake> diagnose(const wave::Recording& recording,
                                const SolveOptions& options,
                                bool contradicts,
                                const wave::ProgressCallback& progress) {
  return Diagnosis(recording, options, progress).run(contradicts);
}

}  // namespace wiimote_tracker::session
