#pragma once

#include "capture/corner_capture.h"
#include "capture/hands_free.h"
#include "samples/samples.h"
#include "wave/coverage.h"
#include "workflow/captured.h"
#include "workflow/reply.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
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
  square::SquareLayout layout;  ///< Of every square, but for its sides, lengths and places.
  std::string world_frame = "world";
};

/// What a person has done before the start.
struct Preparation {
  bool lights_learned = false;
  bool connection_checked = false;
};

/// The calibration from start to a saved rig, step by step. A request that cannot be done now is
/// refused with a reason, and changes nothing. While something takes time, and until it has stopped
/// after a cancel, every request but cancel() is refused. Whoever makes a request shows the reply
/// with shown(); what comes of images and of time is shown here. Times [s] are of the clock that
/// stamps the images.
class Calibration {
 public:
  explicit Calibration(const CalibrationOptions& options) : options_(options) {}

  /// Starts a run with a square. What the run before captured is dropped; the rig stays.
  /// @param side_x, side_y sides of the rectangle [m].
  Reply start(double side_x, double side_y, const std::vector<std::string>& cameras);

  /// Starts a run without a square, for a wand.
  Reply startWithoutSquare(const std::vector<std::string>& cameras);

  /// Begins to capture the next missing corner, or `retake` again (0..3).
  Reply beginCapture(std::optional<std::size_t> retake, double now);

  /// Ends the running capture, if any; earlier captures stay.
  void abandonCapture(const std::string& why);

  /// Whether a corner is captured automatically when the LED is still at a new place.
  void setHandsFree(bool on);
  bool isHandsFree() const { return hands_free_on_; }

  /// Begins to record a wave; an earlier one of this run is dropped.
  /// @param cameras of this run: names, image sizes, and poses if `posed`, which measure the volume
  /// passed through. @param wand nothing: one LED is waved.
  Reply beginWave(const std::vector<geometry::Camera>& cameras,
                  bool posed,
                  const std::optional<wave::Wand>& wand,
                  double now);
  Reply endWave();

  /// Ends the wave that is being recorded, if any; what was recorded stays.
  void abandonWave(const std::string& why);

  /// One image of one camera; images in the order of their stamps.
  void addImage(const capture::Image& image);

  /// Advances the time when no image does.
  void update(double now);

  /// Takes a length by tape between two captured corners, in place of an earlier one between them;
  /// a length of 0 drops that. Refused when the sides and the errors of the placement do not allow
  /// it. A corner that is captured again loses its lengths.
  /// @param placement of the LED on a corner: standard deviation per axis [m].
  Reply measureLength(const square::TapedLength& taped, double placement);

  /// Why no known place can be taken now, and what to do; empty: it can. The rig in use must be the
  /// solution of what was captured: a camera may have moved since the corners were.
  std::string whyNoPlace() const { return captured_.whyNoPlace(rig_); }

  /// Takes where cameras saw the LED on a known place, while kMeasuring. Refused as whyNoPlace().
  Reply addPlace(const square::KnownPlace& known, const capture::CapturedCorner& seen);

  /// Drops the last length if nothing was captured after it, else the last place to solve with,
  /// else the wave, else the last corner.
  Reply undo();

  /// Stops the running step; earlier captures stay. When none is running, it drops all that was
  /// captured, except right after the solver ended: that cancel was meant for the solver. The rig
  /// stays.
  Reply cancel();

  /// Begins kSolving, kMasking or kMeasuring. The caller does the work and then calls end(), also
  /// when it failed. Refused while another step is running, and kSolving without enough data; a
  /// wave that is enough is ended by kSolving.
  /// @param is_waved whether the LED is waved meanwhile, not held still.
  Reply begin(Step step, const std::string& message, bool is_waved = false);

  /// Whether the step is running and was not cancelled.
  bool isBusyWith(Step step) const { return busy_ == step && !stopping_; }

  /// Whether the running step was cancelled.
  bool isStopping() const { return stopping_; }

  /// @throws Error: a step is running, or has not stopped yet.
  void requireIdle() const {
    if (busy_)
      throw Error(occupied());
  }

  /// Whether kMeasuring, which is running, needs the LED waved.
  bool isWaved() const { return is_waved_; }

  /// Progress of the running step [0..1].
  void setProgress(double progress) { progress_ = progress; }

  /// Ends the running step.
  void end();

  /// Uses the result of kSolving, with the zones of the previous rig if the world frames have the
  /// same name. @returns its verdict.
  Reply takeSolution(const geometry::Rig& rig);

  /// Notes that the solver refused what was captured, until something else is captured or dropped.
  void refuseSolution(const RefusedSolution& refused) { captured_.refused = refused; }
  const std::optional<RefusedSolution>& refusedSolution() const { return captured_.refused; }

  /// All that was captured so far. @param facts, masks for every camera of the run that is known;
  /// after restore() the facts are those of the samples file.
  samples::Samples samples(const CameraFacts& facts, const capture::Masks& masks) const {
    return toSamples(captured_, facts, masks);
  }

  /// Replaces what was captured by saved samples; keeps the rig.
  Reply restore(const samples::Samples& samples);

  /// Whether the data come from a samples file, which has its own facts.
  bool isRestored() const { return !captured_.restored_facts.empty(); }

  /// Whether something was captured since the rig in use was solved, or for another rig.
  bool isUnsolved() const { return step_ == Step::kReady || step_ == Step::kComplete; }

  /// Uses a rig that was read from a file. Refused while a step is running.
  Reply load(const geometry::Rig& rig);

  /// Uses a changed rig. It is saved if the newest file that was saved or loaded has it.
  void setRig(const geometry::Rig& rig, const std::string& message);

  /// Gives the rig these masks. They move no point: a correction of the volume stays valid.
  /// @returns whether there is a rig and it changed; then it differs from its file.
  bool setMasks(const capture::Masks& masks);

  /// Says which rig the one in use approaches in steps, until another one is used: setRig() is to
  /// use each step. Nothing: none.
  void setGoal(const std::optional<geometry::Rig>& goal) { goal_ = goal; }
  const std::optional<geometry::Rig>& goal() const { return goal_; }

  /// Notes that a rig was written to a file: the one in use, or its goal.
  void saved(const geometry::Rig& rig);

  /// Makes a reply the message(), and counts it if it is a refusal. @returns it.
  Reply shown(const Reply& reply);

  Preparation& preparation() { return preparation_; }
  const Preparation& preparation() const { return preparation_; }

  Step step() const { return busy_.value_or(step_); }
  const std::string& message() const { return message_; }
  /// How often something was refused so far.
  std::size_t refusals() const { return refusals_; }
  /// How often a corner was captured so far, also again, or a wand on the floor.
  std::size_t captures() const { return captures_; }
  double progress() const;
  /// What is still missing before this can be solved, most urgent first; one sentence each.
  std::vector<std::string> missing() const;
  /// Empty when nothing is started.
  const std::vector<std::string>& cameras() const { return captured_.cameras; }
  const SquareRun& square() const { return captured_.square; }
  /// Nothing when nothing is started, or without a square.
  const std::optional<square::SquareLayout>& layout() const { return captured_.layout; }
  /// The wave that is being recorded, or was.
  const std::optional<WaveRecorder>& wave() const { return captured_.wave; }
  const std::optional<geometry::Rig>& rig() const { return rig_; }

 private:
  Reply startWith(Captured captured);
  /// Takes what a capture that has ended gave.
  void finishCapture();
  /// Why no step can begin now.
  std::string occupied() const;
  /// Updates the step after what changes the captured data. @returns the reply.
  Reply changed(const Reply& reply);
  /// Replaces the rig in use.
  void use(const geometry::Rig& rig);
  /// kSolved or kSaved, by whether a file has the rig in use.
  Step stepOfRig() const;
  /// The step between two requests, by what is captured.
  void updateStep() { step_ = captured_.isComplete() ? Step::kComplete : Step::kReady; }

  CalibrationOptions options_;
  Step step_ = Step::kIdle;   // between two requests
  std::optional<Step> busy_;  // the running step
  bool stopping_ = false;     // it was cancelled, but has not ended yet
  bool is_waved_ = false;     // as begin() was told
  bool just_solved_ = false;  // no request since the solver ended
  double progress_ = 0.0;     // of the running step, by setProgress()
  std::string message_ = "nothing started: start a calibration, or load a rig";
  std::size_t refusals_ = 0;
  std::size_t captures_ = 0;
  Preparation preparation_;
  Captured captured_;
  bool hands_free_on_ = false;
  std::optional<capture::HandsFree> hands_free_;
  std::optional<geometry::Rig> rig_;
  std::optional<geometry::Rig> goal_;
  std::optional<geometry::Rig> in_file_;  // as it was saved or loaded
};

}  // namespace wiimote_tracker::workflow
