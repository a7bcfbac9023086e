#include "adjustment.h"

#include "adjust/camera_blocks.h"
#include "adjust/chi_squared.h"
#include "adjust/covariance.h"
#include "adjust/path.h"
#include "adjust/pixel.h"
#include "adjust/prior.h"
#include "adjust/solver.h"
#include "square/known_terms.h"
#include "wave/error.h"

#include <ceres/iteration_callback.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <optional>
#include <set>

namespace wiimote_tracker::wave {

namespace {

// Of the distance between the paths of a wand's LEDs [m]: far below what cameras resolve.
constexpr double kStickStddev = 0.0002;

// Of coordinates of the wand on the floor that define the world, far below what cameras resolve
// [m].
constexpr double kExact = 1e-5;

// With less redundancy (degrees of freedom per residual) the residuals do not tell the noise.
constexpr double kLeastRedundancy = 0.1;

constexpr double kNoLoss = std::numeric_limits<double>::infinity();

/// Reports before each iteration. What that throws waits until Ceres, which knows no exceptions,
/// has ended.
class Reporting : public ceres::IterationCallback {
 public:
  explicit Reporting(const std::function<void()>& report) : report_(report) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    try {
      report_();
      return ceres::SOLVER_CONTINUE;
    } catch (...) {
      thrown_ = std::current_exception();
      return ceres::SOLVER_ABORT;
    }
  }

  void rethrow() const {
    if (thrown_)
      std::rethrow_exception(thrown_);
  }

 private:
  const std::function<void()>& report_;
  std::exception_ptr thrown_;
};

/// The least-squares problem around one state, whose path, corners and wand it changes in place.
class WaveProblem {
 public:
  WaveProblem(const Task& task, const std::vector<Match>& matches, double loss_scale, State* state)
      : recording_(task.recording), options_(task.options), state_(*state) {
    for (std::size_t i = 0; i < state->cameras.size(); ++i)
      cameras_.emplace_back(state->cameras[i], state->offsets[i]);
    addMatches(matches, loss_scale);
    addPath();
    if (recording_.wand)
      addWand(matches);
    known_.addLenses(recording_.sightings(), &state->shared_offset);
    // The first one's is held at 0: it cannot disagree.
    for (std::size_t i = 1; i < cameras_.size(); ++i)
      known_.add(adjust::priorOf(0.0, options_.offset), cameras_[i].timeOffset());
    if (recording_.square)
      known_.addSquare(*recording_.square, state->z_up, recording_.sightings(),
                       &state->corner_offsets, &state->places);
    if (state->floor)
      addFloor();
    holdGauge();
  }

  /// @param tolerance relative change of the sum of squares at which it ends.
  void solve(double tolerance, const std::function<void()>& report) {
    Reporting callback(report);
    ceres::Solver::Options options =
        adjust::solverOptions(ceres::SPARSE_NORMAL_CHOLESKY, 60, {tolerance, 1e-14, 1e-12});
    // Most rounds start close to their solution. With Ceres' default radius of 1e4, the parameters
    // that pixels hardly determine would need five more steps.
    options.initial_trust_region_radius = 1e8;
    options.max_num_consecutive_invalid_steps = 20;  // the trust region shrinks before
    options.callbacks = {&callback};
    const bool is_solved = adjust::minimise(options, &problem_).IsSolutionUsable();
    callback.rethrow();
    if (!is_solved)
      throw WaveContradiction(
          "the LED would be behind the cameras in the solution: check that nobody moved a camera, "
          "and record again");
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      state_.cameras[i] = cameras_[i].cameraLike(state_.cameras[i]);
      state_.offsets[i] = *cameras_[i].timeOffset();
    }
  }

  double noiseRatio() {
    return std::sqrt(adjust::squaresOf(&problem_, matches_) / residuals() /
                     redundancy().value_or(1.0));
  }

  std::optional<double> redundancy() const {
    const double share = freedom_ / residuals();
    return share > kLeastRedundancy ? std::optional(share) : std::nullopt;
  }

  Agreement agreement() const { return {known_.chiSquared(), known_.degreesOfFreedom()}; }

  /// As covarianceOf().
  Eigen::MatrixXd covariance() {
    std::vector<double*> blocks = adjust::blocksOf(&cameras_);
    if (recording_.square) {
      for (Eigen::Vector2d& corner : state_.corner_offsets)
        blocks.push_back(corner.data());
    }
    const auto covariance = adjust::covarianceOf(&problem_, blocks);
    if (!covariance)
      throw WaveError(
          "the recording does not determine the cameras: wave longer, through more of the volume");
    return *covariance;
  }

 private:
  double residuals() const { return 2.0 * static_cast<double>(matches_.size()); }

  void addMatches(const std::vector<Match>& matches, double loss_scale) {
    Trajectory& path = state_.trajectory;
    for (const Match& match : matches) {
      adjust::CameraBlocks& camera = cameras_[match.camera];
      const adjust::PixelError pixel(camera, match.pixel, match.whitening);
      matches_.push_back(camera.addTo(
          &problem_,
          adjust::PathPixelError{pixel, match.stamp - path.timeOf(match.interval), path.spacing()}
              .cost(),
          adjust::lossOf(loss_scale), camera.timeOffset(), path.control(match.interval, match.led),
          path.control(match.interval + 1, match.led), path.control(match.interval + 2, match.led),
          path.control(match.interval + 3, match.led)));
      for (Eigen::Index k = 0; k < 4; ++k)
        fitted_.insert(path.control(match.interval + k, match.led));
    }
    const int per_camera = adjust::kRotationSize + adjust::kPositionSize + adjust::kLensSize + 1;
    freedom_ = residuals() - 3.0 * static_cast<double>(fitted_.size()) -
               static_cast<double>(per_camera) * static_cast<double>(cameras_.size());
  }

  void addPath() {
    Trajectory& path = state_.trajectory;
    const adjust::PathAccelerationError error{path.spacing(), options_.acceleration};
    for (Eigen::Index led = 0; led < path.leds(); ++led) {
      for (Eigen::Index k = 0; k + 2 < path.controls().cols(); ++k)
        problem_.AddResidualBlock(error.cost(), nullptr, path.control(k, led),
                                  path.control(k + 1, led), path.control(k + 2, led));
    }
  }

  void addWand(const std::vector<Match>& matches) {
    Trajectory& path = state_.trajectory;
    for (const Eigen::Index k : seenIntervals(matches)) {
      const std::array<double*, 6> controls = {path.control(k, 0),     path.control(k + 1, 0),
                                               path.control(k + 2, 0), path.control(k, 1),
                                               path.control(k + 1, 1), path.control(k + 2, 1)};
      problem_.AddResidualBlock(adjust::WandLengthError{kStickStddev}.cost(), nullptr, controls[0],
                                controls[1], controls[2], controls[3], controls[4], controls[5],
                                &state_.wand_length);
      // Beside an LED that was not seen, the stick tells nothing of the one that was.
      if (std::all_of(controls.begin(), controls.end(),
                      [this](const double* control) { return fitted_.count(control) > 0; }))
        freedom_ += 1.0;
    }
    known_.add(adjust::priorOf(recording_.wand->length, recording_.wand->stddev),
               &state_.wand_length);
  }

  /// The wand at rest, whose LEDs define origin and x axis, and the accelerometers.
  void addFloor() {
    WandOnFloor& floor = *state_.floor;
    const Eigen::Vector3d origin(0.0, 0.0, *recording_.wand->led_height);
    known_.add(adjust::priorOf(origin, Eigen::Vector3d::Constant(kExact)), floor.leds[0].data());
    // How far the other end lies along the x axis is left to the images.
    Eigen::Matrix<double, 2, 3> across = Eigen::Matrix<double, 2, 3>::Zero();
    across(0, 1) = 1.0 / kExact;
    across(1, 2) = 1.0 / options_.uncertainty.placement;
    known_.add(new ceres::NormalPrior(across, origin), floor.leds[1].data());
    for (std::size_t led = 0; led < floor.leds.size(); ++led) {
      for (std::size_t i = 0; i < cameras_.size(); ++i) {
        if (floor.spots[i])
          known_.addPixel(i, (*floor.spots[i])[led], floor.leds[led].data());
      }
    }
    known_.addGravity(recording_.sightings(), Eigen::Vector3d::UnitZ());
  }

  /// All clocks could be shifted together with the path, and without square or floor all cameras
  /// moved.
  void holdGauge() {
    problem_.SetParameterBlockConstant(cameras_.front().timeOffset());
    if (recording_.square || state_.floor)
      return;
    problem_.SetParameterBlockConstant(cameras_.front().rotation());
    problem_.SetParameterBlockConstant(cameras_.front().position());
  }

  const Recording& recording_;
  const WaveOptions& options_;
  State& state_;
  std::vector<adjust::CameraBlocks> cameras_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> matches_;
  std::set<const double*> fitted_;  // control points that matches tell of
  square::KnownTerms known_{options_.uncertainty, &cameras_, &problem_};
  double freedom_ = 0.0;  // residuals of the matches beyond the number of parameters
};

}  // namespace

bool Agreement::isContradiction() const {
  return chi_squared >
         adjust::chiSquaredQuantile(std::max(1.0, degrees_of_freedom), adjust::kThreeNines);
}

Refinement refine(const Task& task,
                  const std::vector<Match>& matches,
                  double loss_scale,
                  const std::function<void()>& report,
                  State* state) {
  WaveProblem problem(task, matches, loss_scale, state);
  // A robust fit is only the start of a tighter one.
  problem.solve(std::isfinite(loss_scale) ? 1e-4 : 1e-9, report);
  return {problem.redundancy(), problem.noiseRatio()};
}

Agreement agreementOf(const Task& task, const std::vector<Match>& matches, State solution) {
  return WaveProblem(task, matches, kNoLoss, &solution).agreement();
}

Eigen::MatrixXd covarianceOf(const Task& task, const std::vector<Match>& matches, State solution) {
  return WaveProblem(task, matches, kNoLoss, &solution).covariance();
}

}  // namespace wiimote_tracker::wave
