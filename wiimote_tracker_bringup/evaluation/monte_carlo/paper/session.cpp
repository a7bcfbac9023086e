#include "session.h"

#include "experiment.h"

#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"
#include "wiimote_tracker_calibration/simulation/simulated_board.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr int kDraws = 2000;  // most draws of lenses
constexpr int kImages = 100;  // of a still LED
constexpr std::size_t kBoardViews = 12;
constexpr double kWandLength = 0.5;    // [m]
constexpr double kStampWander = 3e-4;  // of the driver's clock estimate [s]
constexpr double kGravity = 9.81;

/// An LED placed at a point, without pixels.
StillLed put(const Eigen::Vector3d& nominal, std::mt19937_64& random) {
  return {nominal, placed(nominal, random), {}};
}

/// The mean of whole pixels, as reported by a Wii Remote.
void look(const std::vector<geometry::Camera>& cameras,
          double pixel_noise,
          std::mt19937_64& random,
          StillLed* led) {
  std::normal_distribution<double> normal;
  for (const geometry::Camera& camera : cameras) {
    led->pixels.emplace_back();
    if (!camera.sees(led->truth))
      continue;
    const Eigen::Vector2d exact = *camera.project(led->truth);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int i = 0; i < kImages; ++i) {
      const double u = std::round(exact.x() + pixel_noise * normal(random));
      sum += Eigen::Vector2d(u, std::round(exact.y() + pixel_noise * normal(random)));
    }
    led->pixels.back() = sum / kImages;
  }
}

/// All points of the experiment that cameras must see.
std::vector<StillLed> whatMatters(const std::vector<StillLed>& points) {
  std::vector<StillLed> all = points;
  for (const StillLed& led : points)
    all.push_back({led.nominal, led.nominal, {}});
  for (std::size_t circle = 0; circle < circleCenters().size(); ++circle) {
    for (int i = 0; i < 36; ++i) {
      const Eigen::Vector3d place = onCircle(circle, 2.0 * M_PI * i / 36.0);
      all.push_back({place, place, {}});
    }
  }
  return all;
}

/// Whether each camera sees all points that it sees in the description.
bool isAimed(const simulation::Description& description,
             const std::vector<std::size_t>& described,
             const std::vector<geometry::Camera>& cameras,
             const std::vector<StillLed>& wanted) {
  for (const StillLed& led : wanted) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      if (description.cameras[described[i]].camera.sees(led.nominal) && !cameras[i].sees(led.truth))
        return false;
    }
  }
  return true;
}

geometry::Intrinsics lensFromBoard(const geometry::Intrinsics& truth,
                                   double pixel_noise,
                                   std::uint32_t seed) {
  // Like Matlab's toolbox, which states the uncertainty of a result but does not refuse it.
  intrinsics::SolverOptions options;
  options.model = intrinsics::LensModel::kNoDistortion;
  options.minimum_views = kBoardViews;
  options.maximum_focal_stddev = std::numeric_limits<double>::max();
  options.maximum_pixel_stddev = std::numeric_limits<double>::max();
  options.maximum_aspect_error = std::numeric_limits<double>::max();
  return intrinsics::solveIntrinsics(
             intrinsics::simulatedSamples(truth, kBoardViews, pixel_noise, seed), options)
      .intrinsics;
}

}  // namespace

double stillPixelStddev(const simulation::Description& description) {
  return std::sqrt((description.pixel_noise * description.pixel_noise + 1.0 / 12.0) / kImages);
}

PaperSession drawPaperSession(const simulation::Description& description,
                              const std::vector<std::size_t>& cameras,
                              std::uint32_t seed) {
  std::mt19937_64 random(seed);
  wave::WaveScene scene;
  scene.uncertainty = square::Uncertainty();
  scene.uncertainty.principal_point = 15.0;
  scene.uncertainty.shared_principal_point = 0.0;
  scene.pixel = description.pixel_noise;
  scene.wander = kStampWander;
  for (const std::size_t i : cameras)
    scene.cameras.push_back(description.cameras[i].camera.world_from_camera);

  std::vector<StillLed> points;
  for (const Eigen::Vector3d& point : tenPoints())
    points.push_back(put(point, random));
  const std::vector<StillLed> wanted = whatMatters(points);

  // No wave is needed to check the lenses.
  wave::WaveScene still = scene;
  still.duration = 0.0;
  std::optional<wave::SimulatedWave> aimed;
  for (int i = 0; i < kDraws && !aimed; ++i) {
    const wave::SimulatedWave drawn = wave::simulateWave(still, random());
    if (isAimed(description, cameras, drawn.cameras, wanted))
      aimed = drawn;
  }
  if (!aimed)
    throw std::runtime_error(
        "the cameras of the rig's description cannot see all of the paper's points; aim them at "
        "the cube of 2.5 m");
  for (std::size_t i = 0; i < aimed->cameras.size(); ++i) {
    square::CameraSightings& sightings = aimed->recording.cameras[i].sightings;
    sightings.gravity = kGravity * (aimed->cameras[i].world_from_camera.linear().transpose() *
                                    Eigen::Vector3d::UnitZ());
    for (std::size_t c = 0; c < 4; ++c) {
      if (!aimed->cameras[i].sees(aimed->corners[c]))
        sightings.corners[c].reset();
    }
  }

  wave::WaveScene wand_scene = scene;
  wand_scene.length = kWandLength;
  const wave::SimulatedWave wave = wave::waveAgain(scene, *aimed, random());
  const wave::SimulatedWave wand = wave::waveAgain(wand_scene, *aimed, random());
  PaperSession session{scene, wave, wand_scene, wand, {}, points, {}};
  for (const geometry::Camera& camera : aimed->cameras)
    session.board_lenses.push_back(lensFromBoard(camera.intrinsics, description.pixel_noise,
                                                 static_cast<std::uint32_t>(random())));
  for (const double z : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      for (const double x : {0.0, 0.5, 1.0})
        session.known_places.push_back(put(kSide * Eigen::Vector3d(x, y, z), random));
    }
  }
  for (std::vector<StillLed>* leds : {&session.points, &session.known_places}) {
    for (StillLed& led : *leds)
      look(aimed->cameras, description.pixel_noise, random, &led);
  }
  return session;
}

}  // namespace wiimote_tracker::monte_carlo
