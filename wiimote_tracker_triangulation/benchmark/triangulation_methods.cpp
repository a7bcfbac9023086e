#include "triangulation_scene.h"

#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <limits>
#include <optional>

namespace wiimote_tracker {
namespace {

using Way = geometry::TriangulationMethod;

geometry::TriangulationOptions optionsFor(Way method) {
  geometry::TriangulationOptions options;
  options.method = method;
  options.pixel_stddev = kBenchmarkPixelStddev;
  return options;
}

void take(const std::optional<geometry::TriangulatedPoint>& point,
          std::size_t i,
          TriangulationOutput* output) {
  if (!point)
    return;  // it stays NaN
  output->positions[i] = point->position;
  output->covariances[i] = point->covariance;
}

TriangulationMethod fromSights(const std::string& name, Way method) {
  return {name, false, [method](const TriangulationScene& scene) {
            std::vector<geometry::Sight> sights;  // of one point after the other
            for (const auto& pixels : scene.pixels) {
              for (std::size_t c = 0; c < pixels.size(); ++c)
                sights.push_back(*geometry::sightFromPixel(scene.cameras[c], pixels[c]));
            }
            return [sights, views = scene.cameras.size(),
                    options = optionsFor(method)](TriangulationOutput* output) {
              for (std::size_t i = 0; i < output->positions.size(); ++i)
                take(geometry::triangulate(&sights[i * views], views, options), i, output);
            };
          }};
}

/// Includes undistortion.
TriangulationMethod fromPixels() {
  return {"maximum likelihood, from pixels", false, [](const TriangulationScene& scene) {
            std::vector<std::vector<geometry::Observation>> observations;
            for (const auto& pixels : scene.pixels) {
              observations.emplace_back();
              for (std::size_t c = 0; c < pixels.size(); ++c)
                observations.back().push_back({&scene.cameras[c], pixels[c]});
            }
            return [observations,
                    options = optionsFor(Way::kMaximumLikelihood)](TriangulationOutput* output) {
              for (std::size_t i = 0; i < output->positions.size(); ++i)
                take(geometry::triangulate(observations[i], options), i, output);
            };
          }};
}

}  // namespace

TriangulationOutput::TriangulationOutput(std::size_t points)
    : positions(points, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())),
      covariances(points, Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN())) {}

std::vector<TriangulationMethod> ourMethods() {
  return {fromSights("maximum likelihood", Way::kMaximumLikelihood), fromPixels(),
          fromSights("reweighted midpoint", Way::kReweightedMidpoint),
          fromSights("least squares", Way::kLeastSquares),
          fromSights("mean of closest points (paper)", Way::kMeanClosest)};
}

}  // namespace wiimote_tracker
