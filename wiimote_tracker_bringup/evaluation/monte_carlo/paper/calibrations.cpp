#include "calibrations.h"

#include "wiimote_tracker_calibration/square/solve_square.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <deque>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr int kRounds = 14;  // in all of the paper's corrections

std::vector<square::CameraSightings> sightingsOf(const wave::SimulatedWave& wave) {
  std::vector<square::CameraSightings> sightings;
  for (const wave::CameraRecording& camera : wave.recording.cameras)
    sightings.push_back(camera.sightings);
  return sightings;
}

}  // namespace

principal_point::CorrectionResult solvePaperCase(const PaperSession& session,
                                                 PaperCase which,
                                                 geometry::RayModel ray_model) {
  std::vector<square::CameraSightings> sightings = sightingsOf(session.wave);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    geometry::Intrinsics& lens = sightings[i].intrinsics;
    if (which != PaperCase::kC1 && which != PaperCase::kC3)
      lens = session.board_lenses[i];
    if (which == PaperCase::kC5) {
      lens.cx = 0.5 * lens.width;
      lens.cy = 0.5 * lens.height;
    }
  }
  principal_point::CorrectionOptions options;
  options.rounds = which == PaperCase::kC1 || which == PaperCase::kC2 ? 0 : kRounds;
  options.ray_model = ray_model;
  return principal_point::correctPrincipalPoints(*session.wave.recording.square, sightings,
                                                 options);
}

geometry::Rig solveJointSquare(const PaperSession& session) {
  return square::solveSquare(*session.wave.recording.square, sightingsOf(session.wave), {}).rig;
}

geometry::Rig solveWaved(const wave::SimulatedWave& wave) {
  return wave::solveWave(wave.recording, {}).rig;
}

std::optional<geometry::TriangulatedPoint> measure(const PaperSession& session,
                                                   const geometry::Rig& rig,
                                                   const StillLed& led,
                                                   const geometry::TriangulationOptions& options) {
  std::deque<geometry::Camera> cameras;  // the rig may lack some that could not be solved
  std::vector<geometry::Observation> observations;
  for (std::size_t i = 0; i < led.pixels.size(); ++i) {
    const geometry::RigCamera* camera = rig.find(session.wave.cameras[i].name);
    if (camera && led.pixels[i])
      observations.push_back({&cameras.emplace_back(rig.rayCamera(*camera)), *led.pixels[i]});
  }
  return geometry::triangulate(observations, options);
}

}  // namespace wiimote_tracker::monte_carlo
