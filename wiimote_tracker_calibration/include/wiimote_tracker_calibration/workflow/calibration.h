#ifndef WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_CALIBRATION_H
#define WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_CALIBRATION_H

#include "wiimote_tracker_calibration/capture/corner_capture.h"
#include "wiimote_tracker_calibration/capture/hands_free.h"
#include "wiimote_tracker_calibration/capture/masks.h"
#include "wiimote_tracker_calibration/session/session.h"
#include "wiimote_tracker_calibration/wave/coverage.h"
#include "wiimote_tracker_calibration/workflow/reply.h"
#include "wiimote_tracker_calibration/workflow/square_run.h"
#include "wiimote_tracker_calibration/workflow/wave_recorder.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

/// Values as in CalibrationStatus.msg.
enum class Step {
  kIdle = 0,
  kReady = 1,
  kCapturing = 2,
  kWaving = 3,
  kComplete = 4,
  kSolving = 5,
  kSolved = 6,
  kSaved = 7,
  kMasking = 8,
  kMeasuring = 9,
};

struct CalibrationOptions {
  capture::CornerCaptureOptions capture;
  capture::HandsFreeOptions hands_free;
  wave::CoverageOptions coverage;
  double led_height = 0.0;                           ///< As in square::SquareLayout [m].
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< As in square::SquareLayout [m].
  double yaw = 0.0;                                  ///< As in square::SquareLayout [rad].
  std::string world_frame = "world";
};

/// What is known of a camera besides where it saw the LED.
struct CameraFacts {
  std::string identity;                    ///< Empty if unknown.
  geometry::Intrinsics intrinsics;         ///< Starting values.
  std::optional<Eigen::Vector3d> gravity;  ///< Specific force at rest, optical frame [m/s^2].
};

/// The calibration from start to a saved rig, step by step. A request that cannot be done now is
/// refused with a reason, and loses nothing. One thing at a time: while something that takes time
/// goes on, all but cancel() is refused; also while it is being stopped. Times [s] are of the clock that stamps the images.
class Calibration {
 public:
  explicit Calibration(const CalibrationOptions& options) : options_(options) {}

  /// Starts anew with a square; drops what the run before has captured, keeps the rig.
  /// @param side_x, side_y sides of the rectangle [m].
  Reply start(double side_x, double side_y, const std::vector<std::string>& cameras);

  /// Same for a wand that is waved without a square.
  Reply startWithoutSquare(const std::vector<std::string>& cameras);

  /// Begins to capture the next missing corner, or `retake` again (0..3).
  Reply beginCapture(std::optional<std::size_t> retake, double now);

  /// Gives up the capture that goes on; what was captured before stays.
  void abandonCapture(const std::string& why);

  /// From now on a corner is captured by itself when the LED is held still at a new place.
  void setHandsFree(bool on);
  bool isHandsFree() const { return hands_free_on_; }

  /// Begins to record a wave; the one before in this run is dropped.
  /// @param cameras of this run: names, image sizes; poses if `posed`, for the volume that is
  /// passed through. @param wand nothing: one LED is waved.
  Reply beginWave(const std::vector<geometry::Camera>& cameras,
                  bool posed,
                  const std::optional<wave::Wand>& wand,
                  double now);
  Reply endWave();

  /// One image of one camera; images in the order of their stamps.
  void addImage(const capture::Image& image);

  /// Looks at the clock, which goes on without images too.
  void update(double now);

  /// Drops what was captured last: the wave, else the last corner.
  Reply undo();

  /// Stops what goes on, and nothing else: what was captured before stays. When nothing goes on the
  /// run is dropped, but not right after the solver: a cancel that comes too late to stop it drops
  /// nothing, and says so. The rig stays.
  Reply cancel();

  /// Begins something that takes time and is done elsewhere: kMasking or kMeasuring. Refused while
  /// something else goes on.
  Reply begin(Step step, const std::string& message);

  /// Whether it goes on and is not to stop; no longer so after end() or cancel(). Whoever began it
  /// calls end() in any case.
  bool isBusyWith(Step step) const { return busy_ == step && !stopping_; }

  /// How far it is [0..1].
  void setProgress(double progress) { progress_ = progress; }

  /// Ends it, and shows how it ended.
  void end(const Reply& outcome);

  /// Begins kSolving: session() is solved elsewhere, which ends with finishSolve(), or with end()
  /// when it fails. Refused when there is not enough to be solved.
  Reply beginSolve();

  /// Takes over the result, with the zones of the rig before in a world of the same name.
  /// @returns its verdict.
  Reply finishSolve(const geometry::Rig& rig);

  /// All that was captured so far. @param facts, masks for every camera of the run that is known;
  /// after restore() those of what was restored take the place of the facts.
  session::Session session(const std::map<std::string, CameraFacts>& facts,
                           const capture::Masks& masks) const;

  /// Goes on from what was captured before, in the place of the run so far; keeps the rig.
  Reply restore(const session::Session& session);

  /// Whether the run was restored, so that it has its own facts.
  bool isRestored() const { return !restored_facts_.empty(); }

  /// Takes over a rig that was read from a file. Refused while something goes on.
  Reply load(const geometry::Rig& rig);

  /// Takes over a rig that was made of the one before, and is not saved yet.
  void setRig(const geometry::Rig& rig, const std::string& message);

  /// Gives the rig these masks, which move no point: a correction of its volume stays good.
  /// @returns whether there is a rig and they are new to it; then it differs from its file.
  bool setMasks(const capture::Masks& masks);

  /// Notes that the rig was written to a file.
  void saved(const std::string& message);

  /// Shows the reason of a failure outside of this class.
  void note(const std::string& message) { message_ = message; }

  Step step() const { return busy_.value_or(step_); }
  const std::string& message() const { return message_; }
  double progress() const;
  /// What is still missing before this can be solved, most urgent first; one sentence each.
  std::vector<std::string> missing() const;
  /// Empty when nothing is started.
  const std::vector<std::string>& cameras() const { return cameras_; }
  const SquareRun& square() const { return square_; }
  /// Along x, along y [m]; empty without a square.
  std::vector<double> sides() const;
  /// The wave that is being recorded, or was.
  const std::optional<WaveRecorder>& wave() const { return wave_; }
  const std::optional<geometry::Rig>& rig() const { return rig_; }

 private:
  Reply startWith(const std::vector<std::string>& cameras,
                  const std::optional<square::SquareLayout>& layout);
  /// Why nothing can be begun now.
  std::string occupied() const;
  Reply refuse(const std::string& message);
  Reply accept(const std::string& message);
  Reply shown(const Reply& reply);
  void clear();
  void settle();
  bool hasWand() const { return wave_ && wave_->wand(); }

  CalibrationOptions options_;
  Step step_ = Step::kIdle;   // when nothing goes on
  std::optional<Step> busy_;  // what goes on
  bool stopping_ = false;     // that is to stop, but has not yet
  bool just_solved_ = false;  // nothing was asked for since the solver ended
  double progress_ = 0.0;     // of that, where it is told from outside
  std::string message_ = "nothing started: start a calibration, or load a rig";
  // What was captured.
  std::vector<std::string> cameras_;
  std::optional<square::SquareLayout> layout_;
  SquareRun square_;
  std::optional<WaveRecorder> wave_;
  std::map<std::string, CameraFacts> restored_facts_;
  std::string world_frame_;
  bool hands_free_on_ = false;
  std::optional<capture::HandsFree> hands_free_;
  std::optional<geometry::Rig> rig_;
};

}  // namespace wiimote_tracker::workflow

#endif  // WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_CALIBRATION_H
