#include "measure_trial.h"

#include "wave_trial.h"

#include "samples/solve_samples.h"
#include "square/expected_error.h"

#include <cmath>
#include <random>

namespace wiimote_tracker::samples {

namespace {

double rms(const wave::SimulatedWave& truth, const Solution& solution) {
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0; i < solution.verdict.predicted_at.size(); ++i) {
    if (std::isfinite(solution.verdict.predicted_stddev[i]))
      places.push_back(solution.verdict.predicted_at[i]);
  }
  return wave::pointErrors(truth.cameras, wave::camerasOf(solution.rig.cameras), places).norm() /
         std::sqrt(static_cast<double>(places.size()));
}

}  // namespace

std::vector<MeasureStep> runMeasureTrial(const wave::WaveScene& scene,
                                         std::uint64_t seed,
                                         int measurements) {
  std::mt19937_64 random(seed);
  wave::WaveScene waved = scene;
  wave::SimulatedWave truth = wave::simulateWave(scene, seed);
  SolveOptions options;
  options.wave = wave::optionsFor(scene);
  options.square.uncertainty = scene.uncertainty;
  std::vector<MeasureStep> steps;
  for (int done = 0;; ++done) {
    Samples samples;
    samples.recording = truth.recording;
    const Solution solution = solveSamples(samples, options);
    const Verdict& verdict = solution.verdict;
    steps.push_back({verdict.expected_error, rms(truth, solution),
                     square::expectedShapeError(solution.rig, verdict.predicted_at), verdict.next});
    if (!verdict.next || done == measurements)
      return steps;
    if (const auto& corners = verdict.next->corners) {
      square::TapedLength taped{(*corners)[0], (*corners)[1]};
      taped.length = (truth.corners[taped.to] - truth.corners[taped.from]).norm() +
                     std::normal_distribution<double>(0.0, taped.stddev)(random);
      truth.recording.square->lengths.push_back(taped);
    } else if (verdict.next->place) {
      square::KnownPlace known;
      std::normal_distribution<double> noise(0.0, 1.0);
      const auto normal = [&] { return noise(random); };
      const Eigen::Vector3d led = *verdict.next->place;
      known.position = led + known.stddev * Eigen::Vector3d(normal(), normal(), normal());
      truth.recording.square->places.push_back(known);
      for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
        auto& seen = truth.recording.cameras[i].sightings.places;
        seen.emplace_back();
        if (truth.cameras[i].sees(led))
          seen.back() = *truth.cameras[i].project(led) +
                        scene.uncertainty.pixel * Eigen::Vector2d(normal(), normal());
      }
    } else {
      waved.duration *= 2.0;
      truth = wave::waveAgain(waved, truth, random());
    }
  }
}

}  // namespace wiimote_tracker::samples
