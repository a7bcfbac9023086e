#include "workflow/next_step.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <array>
#include <vector>

namespace wiimote_tracker::workflow {
namespace {

// Sides outside of these are more often a slip than a square [m].
constexpr double kUsualShortest = 0.3;
constexpr double kUsualLongest = 10.0;

const std::array<const char*, SquareRun::kCorners> kCornerHints = {
    "the world's origin", "along x", "counter-clockwise seen from above puts z up", "the last one"};

std::string cornerTitle(std::size_t corner) {
  return "Corner " + std::to_string(corner + 1);
}

NextStep beforeStart(const Preparation& done) {
  if (!done.lights_learned && !done.connection_checked)
    return {
        "LED off",
        "Switch the LED off or take it away: the lights of the room are learned, to ignore them.",
        "learn_masks", "learn the lights"};
  if (!done.connection_checked)
    return {"LED on", "Switch the LED on and hold it up where all cameras see it.",
            "check_connection", "check that they see it"};
  return {
      "Square",
      "Walk through the volume with the LED to see what the cameras cover. Then measure the side "
      "of the square on the floor, or lay a wand of known length there.",
      "start", "start"};
}

/// Asks back for sides that are hardly meant; empty for usual ones.
std::string doubtAbout(const square::SquareLayout& square) {
  const auto [shortest, longest] = std::minmax(square.side_x, square.side_y);
  if (shortest >= kUsualShortest && longest <= kUsualLongest)
    return "";
  return format("The square is %g m x %g m: if that is wrong, start again. ", square.side_x,
                square.side_y);
}

NextStep nextCorner(const Calibration& calibration) {
  if (!calibration.layout())
    return {"Wand",
            "Take the wand and give its length to begin, or start again with it on the floor.",
            "start_wave", "begin the wave"};
  const std::size_t corner = calibration.square().corners().size();
  const std::string doubt = corner == 0 ? doubtAbout(*calibration.layout()) : "";
  const std::string place = SquareRun::nameOf(corner) + " (" + kCornerHints.at(corner) + ")";
  if (calibration.isHandsFree())
    return {cornerTitle(corner),
            doubt + "Hold the LED still on " + place + " until it is captured."};
  return {cornerTitle(corner), doubt + "Put the LED on " + place + ".", "capture_corner",
          "capture " + SquareRun::nameOf(corner)};
}

NextStep waving(const Calibration& calibration) {
  const WaveRecorder& wave = *calibration.wave();
  if (wave.needsFloor())
    return {"Leave it", "Leave the wand on the floor until it is captured. Its end nearer to " +
                            calibration.cameras().front() +
                            " is the world's origin, the other one lies on the x axis."};
  if (!wave.report().enough())
    return {"Wave", "Wave through the whole volume, high and low, near and far."};
  const char* const enough = "All cameras have seen enough.";
  if (!calibration.layout())  // without a square nothing else is needed
    return {"Enough", enough, "solve", "end the wave and solve"};
  return {"Enough", enough, "stop_wave", "end the wave"};
}

NextStep captureAgain(std::size_t corner, const std::string& otherwise) {
  const std::string name = SquareRun::nameOf(corner);
  return {cornerTitle(corner), "Put the LED on " + name + " again" + otherwise + ".",
          "capture_corner", "capture " + name + " again", corner};
}

NextStep afterRefusal(const RefusedSolution& refused) {
  if (refused.corner)
    return captureAgain(*refused.corner, ", as the answer says");
  return {"Again",
          "What was captured cannot be solved: do again what the answer says, or start "
          "again."};
}

NextStep complete(const Calibration& calibration) {
  if (const auto& refused = calibration.refusedSolution())
    return afterRefusal(*refused);
  if (calibration.wave() && calibration.wave()->report().seconds > 0.0)
    return {"Solve", "All is captured.", "solve", "solve"};
  if (!calibration.layout())
    return nextCorner(calibration);
  if (calibration.square().isClockwise())
    return {
        "z is down",
        "The corners go clockwise, so z will point down. Start again if you want z up, or go on "
        "with the wave.",
        "start_wave", "begin the wave"};
  return {"Wave", "Take the LED in your hand to wave it, or solve from the square alone.",
          "start_wave", "begin the wave"};
}

NextStep correct(const std::vector<std::string>& cameras, continuous::Cause cause) {
  const std::string names = joined(cameras);
  const std::string request = "continuous/apply";
  if (cause == continuous::Cause::kDrift)
    return {"Correct drift",
            "Cameras have drifted since they were calibrated, most of all " + names +
                ". The correction is known.",
            request, "correct them"};
  if (cause == continuous::Cause::kReconnect)
    return {"Correct clocks",
            "Cameras have other clocks since they reconnected, most of all " + names +
                ". The new clocks are known.",
            request, "correct them"};
  const bool is_one = cameras.size() == 1;
  return {"Correct " + (is_one ? names : "cameras"),
          names + (is_one ? " was moved. Its new pose is" : " were moved. Their new poses are") +
              " known.",
          request, is_one ? "correct it" : "correct them"};
}

NextStep check(const Findings& findings) {
  const bool is_one = findings.changed.size() == 1;
  const std::string names = joined(findings.changed);
  return {"Check " + (is_one ? names : "cameras"),
          names + (is_one ? " no longer fits" : " no longer fit") +
              " the calibration: " + findings.remedy + "."};
}

/// What the rig in use needs; nothing: it is well.
std::optional<NextStep> inUse(const Calibration& calibration, const Findings& findings) {
  if (!findings.correctable.empty())
    return correct(findings.correctable, findings.cause);
  // Until the corrected rig is reached, the health still finds what it corrects.
  if (calibration.goal())
    return NextStep{"Wait",  // scripts/guide/guide.py looks for this title
                    "The corrected rig is approached in small steps, so that points do not jump: "
                    "go on. A save keeps the corrected rig already now."};
  if (!findings.changed.empty())
    return check(findings);
  return std::nullopt;
}

NextStep solved(const samples::Verdict& verdict) {
  if (verdict.grade != samples::Grade::kRedo && verdict.doubts_scale)
    return {"Again",
            "Measure the lengths and start again with them in metres, or save all the same."};
  if (verdict.grade != samples::Grade::kRedo)
    return {verdict.grade == samples::Grade::kGood ? "Good" : "Usable",
            "Read the verdict, then save.", "save", "save"};
  if (!verdict.redo_corner)
    return {"Again", "Do again what the verdict says, or save all the same."};
  return captureAgain(*verdict.redo_corner, ", or save all the same");
}

}  // namespace

NextStep nextStep(const Calibration& calibration,
                  const samples::Verdict& verdict,
                  const Findings& findings) {
  const Step step = calibration.step();
  const bool is_in_use = step == Step::kIdle || step == Step::kSaved ||
                         (step == Step::kSolved && verdict.grade != samples::Grade::kRedo);
  if (const auto needed = is_in_use ? inUse(calibration, findings) : std::nullopt)
    return *needed;
  switch (step) {
    case Step::kIdle:
      return beforeStart(calibration.preparation());
    case Step::kReady:
      return nextCorner(calibration);
    case Step::kWaving:
      return waving(calibration);
    case Step::kComplete:
      return complete(calibration);
    case Step::kSolved:
      return solved(verdict);
    case Step::kSolving:
      return {"Solving", "Computing the cameras: wait."};
    case Step::kMasking:
      return {"LED off", "Leave the LED off."};
    case Step::kMeasuring:
      if (calibration.isWaved())
        return {"Wave", "Wave the LED where the camera and two others or more see it."};
      [[fallthrough]];
    case Step::kCapturing:
      return {"Hold still", "Keep the LED still."};
    case Step::kSaved:
      if (!findings.silent.empty())  // scripts/guide/guide.py looks for this title
        return {"No images", "The rig is in use, but " + findings.silent + "."};
  }
  return {"Ready", "The rig is calibrated. To check it, put the LED on a place that you know."};
}

}  // namespace wiimote_tracker::workflow
