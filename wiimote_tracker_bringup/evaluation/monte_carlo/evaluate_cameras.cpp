// Accuracy with two to eight exactly known cameras on a ring: single points, and a tracked LED.
#include "paper/experiment.h"
#include "program.h"
#include "room.h"

#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr int kPoints = 40;        // per session
constexpr double kDuration = 6.0;  // of tracking an LED [s]
constexpr double kSettled = 3.0;   // start of the score [s]
const Eigen::Vector3d kMiddle(1.25, 1.25, 1.0);

/// `count` cameras like those of the description, evenly spaced on the same circle; two at a right
/// angle, as in the paper.
simulation::Description ring(const simulation::Description& like, int count) {
  simulation::Description description = like;
  description.cameras.clear();
  const Eigen::Vector3d first = like.cameras[0].camera.center() - kMiddle;
  const double step = count == 2 ? 0.5 * M_PI : 2.0 * M_PI / count;
  for (int i = 0; i < count; ++i) {
    simulation::CameraDescription camera =
        like.cameras[static_cast<std::size_t>(i) % like.cameras.size()];
    const Eigen::Vector3d place =
        kMiddle + Eigen::AngleAxisd(step * i, Eigen::Vector3d::UnitZ()) * first;
    camera.camera.name = "wiimote_" + std::to_string(i + 1);
    camera.camera.world_from_camera = geometry::lookAt(place, kMiddle, Eigen::Vector3d::UnitZ());
    description.cameras.push_back(camera);
  }
  return description;
}

/// Points anywhere in the cube, from one image per camera, with the noise of the description,
/// rounded to whole pixels.
void measurePoints(const simulation::Description& description,
                   int session,
                   std::mt19937* random,
                   Table* table) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 2.5);
  for (int i = 0; i < kPoints; ++i) {
    const double x = uniform(*random), y = uniform(*random), z = uniform(*random);
    const Eigen::Vector3d place(x, y, z);
    std::vector<geometry::Observation> observations;
    for (const simulation::CameraDescription& camera : description.cameras) {
      const double du = description.pixel_noise * normal(*random);
      const double dv = description.pixel_noise * normal(*random);
      if (!camera.camera.sees(place))
        continue;
      const Eigen::Vector2d pixel = *camera.camera.project(place) + Eigen::Vector2d(du, dv);
      observations.push_back({&camera.camera, pixel.array().round().matrix()});
    }
    geometry::TriangulationOptions options;
    // Rounding adds a variance of 1/12 px^2.
    options.pixel_stddev = std::sqrt(description.pixel_noise * description.pixel_noise + 1.0 / 12);
    for (const auto& [method, name] :
         {std::make_pair(geometry::TriangulationMethod::kMaximumLikelihood, "most_likely"),
          std::make_pair(geometry::TriangulationMethod::kMeanClosest, "mean_closest")}) {
      options.method = method;
      const auto point = geometry::triangulate(observations, options);
      *table << session << description.cameras.size() << name << place.x() << place.y()
             << place.z();
      if (point)
        *table << 1e3 * (point->position - place).norm()
               << 1e3 * std::sqrt(point->covariance.trace());
      else
        *table << std::nan("") << std::nan("");
    }
  }
}

/// A tracked LED on a circle of the paper.
void measureTrack(const simulation::Description& description,
                  int session,
                  std::uint32_t seed,
                  Table* table) {
  const double phase = 1e-3 * (seed % 6283);
  const Path path = [=](double time) {  // at 1 m/s
    return onCircle(kUpperCircle, phase + time / kCircleRadius);
  };
  Room room(description, {path}, seed);
  double squared = 0.0, predicted = 0.0;
  int count = 0;
  const auto take = [&](double time, const tracking::Snapshot& snapshot) {
    if (time < kSettled || snapshot.leds.empty())
      return;
    squared += (snapshot.leds[0].position - path(time)).squaredNorm();
    predicted += snapshot.leds[0].position_covariance.trace();
    ++count;
  };
  trackImages(trueRig(description), {}, record(&room, kDuration), take);
  *table << session << description.cameras.size() << "tracks_1_m_per_s" << std::nan("")
         << std::nan("") << std::nan("") << 1e3 * std::sqrt(squared / count)
         << 1e3 * std::sqrt(predicted / count);
}

void measure(const simulation::Description& like, const Session& session, Table* table) {
  for (int count = 2; count <= 8; ++count) {
    const simulation::Description description = ring(like, count);
    std::mt19937 random(session.seed);
    measurePoints(description, session.number, &random, table);
    measureTrack(description, session.number, session.seed, table);
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "Errors of single points in the cube, by two methods, and of a tracked LED, with two to "
      "eight exactly known cameras on a ring, and the errors predicted by the covariance.",
      {"session", "cameras", "method", "x_m", "y_m", "z_m", "error_mm", "predicted_mm"},
      wiimote_tracker::monte_carlo::measure);
}
