#include "diagnose.h"

#include "hypotheses.h"
#include "judge.h"
#include "wave/error.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace wiimote_tracker::samples {

namespace {

// A hypothesis with a smaller misfit is taken, without others that leave out more of the data.
constexpr double kGood = 1.2;
// Hypotheses whose misfits differ by less than this ratio are both named.
constexpr double kAlike = 1.2;

class Diagnosis {
 public:
  Diagnosis(const wave::Recording& recording,
            const SolveOptions& options,
            const wave::ProgressCallback& progress)
      : recording_(recording), options_(options), progress_(progress) {
    // Of 500 images or more, half tell as much in half the time.
    for (wave::CameraRecording& camera : recording_.cameras) {
      const std::size_t stride = camera.frames.size() >= 500 ? 2 : 1;
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
    const Hypothesis as_is{recording_, options_.square.uncertainty};
    // Too many images may show what is not modelled, such as clocks that wander.
    if (const auto found = solve(recording_, as_is.uncertainty); found && !found->contradicts)
      return std::nullopt;
    std::optional<square::Solution> free;
    if (const auto& layout = recording_.square) {
      square::Uncertainty freed = as_is.uncertainty;
      freed.placement = 0.1 * std::min(layout->side_x, layout->side_y);
      free = solve(recording_, freed);
    }
    if (!test(likelyMistakes(as_is, free)) && !test(movedCameras(as_is)))
      test(wrongCameras(as_is));
    return best();
  }

 private:
  /// scaleQuestion() of the square alone: a wave does not fit a wrong scale.
  std::string scaleOfSquare() {
    if (!recording_.square || !recording_.hasFrames())
      return "";
    wave::Recording corners = recording_;
    for (wave::CameraRecording& camera : corners.cameras)
      camera.frames.clear();
    const auto found = solve(corners, options_.square.uncertainty);
    if (!found)
      return "";
    return scaleQuestion(recording_, found->rig, found->path);
  }

  /// Solves hypotheses. @returns whether one of all so far explains the data well.
  bool test(const Hypotheses& hypotheses) {
    for (const Hypothesis& hypothesis : hypotheses) {
      const auto found = solve(hypothesis.recording, hypothesis.uncertainty);
      if (found && !found->contradicts)
        causes_.emplace_back(
            hypothesis.factor * found->misfit,
            Mistake{hypothesis.describe(*found), hypothesis.uncertainty.unknown_corner});
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

  std::optional<square::Solution> solve(const wave::Recording& recording,
                                        const square::Uncertainty& uncertainty) {
    if (progress_)
      progress_("looking for the mistake", 1.0);
    try {
      SolveOptions options = options_;
      options.square.method = square::Method::kJoint;
      options.square.uncertainty = uncertainty;
      return solveRecording(recording, options);
    } catch (const geometry::Error&) {
      return std::nullopt;
    }
  }

  wave::Recording recording_;
  const SolveOptions& options_;
  const wave::ProgressCallback& progress_;
  std::vector<std::pair<double, Mistake>> causes_;  // with their misfits, the best first
};

}  // namespace

std::optional<Mistake> diagnose(const wave::Recording& recording,
                                const SolveOptions& options,
                                bool contradicts,
                                const wave::ProgressCallback& progress) {
  return Diagnosis(recording, options, progress).run(contradicts);
}

}  // namespace wiimote_tracker::samples
