#ifndef WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_CALIBRATION_H
#define WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_CALIBRATION_H

#include "wiimote_tracker_calibration/capture/corner_capture.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

/// Answer to one request: whether it was done, and one sentence that says what was done, or why
/// not and what to do.
struct Reply {
  bool success = false;
  std::string message;
};

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
  square::SolveOptions solve;
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
/// goes on, all but cancel() is refused. Times [s] are of the clock that stamps the images.
class Calibration {
 public:
  static constexpr std::size_t kCorners = 4;

  explicit Calibration(const CalibrationOptions& options) : options_(options) {}

  /// Starts anew; drops the corners of the run before, keeps the rig.
  /// @param side_x, side_y sides of the rectangle [m].
  Reply start(double side_x, double side_y, const std::vector<std::string>& cameras);

  /// Begins to capture the next missing corner, or `retake` again (0..3).
  Reply beginCapture(std::optional<std::size_t> retake, double now);

  /// One image of one camera; images in the order of their stamps. Ends a capture that is over.
  void addImage(const capture::Image& image);

  /// Looks at the clock, which goes on without images too.
  void update(double now);

  /// How the last capture ended; nothing while it goes on, and before the first.
  const std::optional<Reply>& captureOutcome() const { return capture_outcome_; }

  /// Gives up the capture that goes on; what was captured before stays.
  void abandonCapture(const std::string& why);

  /// Drops the corner that was captured last.
  Reply undo();

  /// Stops what goes on. A capture, or nothing, goes on: drops the whole run; keeps the rig.
  Reply cancel();

  /// Begins something that takes time and is done elsewhere: kMasking or kMeasuring. Refused while
  /// something else goes on.
  Reply begin(Step step, const std::string& message);

  /// Whether it goes on; no longer so after end() or cancel().
  bool isBusyWith(Step step) const { return busy_ == step; }

  /// How far it is [0..1].
  void setProgress(double progress) { progress_ = progress; }

  /// Ends it, and shows how it ended. Nothing to end after a cancel().
  void end(const Reply& outcome);

  /// Announces solve(), so that it can be shown. Refused when corners are missing.
  Reply beginSolve();

  /// Solves the rig from the corners. On failure the rig before and the corners stay.
  /// @param facts for every camera of the run that is known. @param time for Rig::solved_at [s].
  Reply solve(const std::map<std::string, CameraFacts>& facts, double time);

  /// Takes over a rig that was read from a file. Refused while something goes on.
  Reply load(const geometry::Rig& rig);

  /// Takes over a rig that was made of the one before, and is not saved yet.
  void setRig(const geometry::Rig& rig, const std::string& message);

  /// Notes that the rig was written to a file.
  void saved(const std::string& message);

  /// Shows the reason of a failure outside of this class.
  void note(const std::string& message) { message_ = message; }

  Step step() const { return busy_.value_or(step_); }
  const std::string& message() const { return message_; }
  double progress() const;
  const std::vector<std::string>& cameras() const { return cameras_; }
  const std::vector<capture::CapturedCorner>& corners() const { return corners_; }
  /// Along x, along y [m]; empty before the start.
  const std::vector<double>& sides() const { return sides_; }
  /// The corner that is being captured, counted from 0.
  std::size_t currentCorner() const { return current_corner_; }
  /// Nothing unless a corner is being captured.
  const std::optional<capture::CornerCapture>& currentCapture() const { return capture_; }
  const std::optional<geometry::Rig>& rig() const { return rig_; }

 private:
  /// Why nothing can be begun now; empty when it can.
  std::string occupied() const;
  Reply refuse(const std::string& message);
  Reply accept(const std::string& message);
  void finishCapture();
  void endCapture(const Reply& outcome);
  void settle();
  std::optional<std::size_t> cornerInSamePlace(const capture::CapturedCorner& corner) const;

  CalibrationOptions options_;
  Step step_ = Step::kIdle;   // when nothing goes on
  std::optional<Step> busy_;  // what goes on
  double progress_ = 0.0;     // of that, unless a corner is being captured
  std::string message_ = "nothing started: start a calibration, or load a rig";
  std::vector<std::string> cameras_;
  std::vector<double> sides_;
  std::vector<capture::CapturedCorner> corners_;
  std::size_t current_corner_ = 0;
  std::optional<capture::CornerCapture> capture_;
  std::optional<Reply> capture_outcome_;
  std::optional<geometry::Rig> rig_;
};

}  // namespace wiimote_tracker::workflow

#endif  // WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_CALIBRATION_H
