#include "triangulation_methods.h"

#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <limits>
#include <memory>

namespace wiimote_tracker {
namespace {

using geometry::TriangulationMethod;

geometry::TriangulationOptions optionsFor(TriangulationMethod method) {
  geometry::TriangulationOptions options;
  options.method = method;
  options.pixel_stddev = kBenchmarkPixelStddev;
  return options;
}

void take(const std::optional<geometry::TriangulatedPoint>& point,
          std::size_t i,
          TriangulationOutput* output) {
  if (!point) {
    output->positions[i].setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  output->positions[i] = point->position;
  output->covariances[i] = point->covariance;
}

TriangulationMethodUnderTest fromSights(const std::string& name, TriangulationMethod method) {
  return {name, true, false, [method](const TriangulationScene& scene) {
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
TriangulationMethodUnderTest fromPixels() {
  return {"maximum likelihood, from pixels", true, false, [](const TriangulationScene& scene) {
            std::vector<std::vector<geometry::Observation>> observations;
            for (const auto& pixels : scene.pixels) {
              observations.emplace_back();
              for (std::size_t c = 0; c < pixels.size(); ++c)
                observations.back().push_back({&scene.cameras[c], pixels[c]});
            }
            return [observations, options = optionsFor(TriangulationMethod::kMaximumLikelihood)](
                       TriangulationOutput* output) {
              for (std::size_t i = 0; i < output->positions.size(); ++i)
                take(geometry::triangulate(observations[i], options), i, output);
            };
          }};
}

}  // namespace

std::vector<TriangulationMethodUnderTest> ourMethods() {
  return {fromSights("maximum likelihood", TriangulationMethod::kMaximumLikelihood), fromPixels(),
          fromSights("reweighted midpoint", TriangulationMethod::kReweightedMidpoint),
          fromSights("least squares", TriangulationMethod::kLeastSquares),
          fromSights("mean of closest points (paper)", TriangulationMethod::kMeanClosest)};
}

}  // namespace wiimote_tracker
