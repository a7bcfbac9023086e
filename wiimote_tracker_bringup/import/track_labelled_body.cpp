// Tracks a rigid body whose lights are labelled in every image.

#include "wiimote_tracker_triangulation/body/body_tracker.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace wiimote_tracker::import {
namespace {

/// Longest time between two images that tell how the lights move [s].
constexpr double kLongestStep = 0.05;
/// The body is searched for anew after this many images that show it elsewhere.
constexpr int kMostMisses = 2;

struct Image {
  double time = -std::numeric_limits<double>::infinity();  // [s]
  std::vector<Eigen::Vector2d> pixels;                     // in the order of the body's LEDs
};

/// What a camera saw last, and before.
struct View {
  Image last;
  Image before;
  int misses = 0;  // images in a row that the tracked body does not explain

  void add(double time, const std::vector<Eigen::Vector2d>& pixels) {
    std::swap(last, before);
    last.time = time;
    last.pixels = pixels;
  }

  /// An LED's pixel, moved on to another time; nothing if it is not known how the light moves.
  std::optional<Eigen::Vector2d> pixelAt(double time, std::size_t led) const {
    const double step = last.time - before.time;
    if (step > kLongestStep || time - last.time > kLongestStep)
      return std::nullopt;
    const Eigen::Vector2d motion = last.pixels[led] - before.pixels[led];
    return last.pixels[led] + (time - last.time) / step * motion;
  }
};

/// The LEDs that two cameras see.
std::vector<body::LabelledPoint> locate(const geometry::Rig& rig,
                                        const std::vector<View>& views,
                                        const body::Constellation& body,
                                        double time,
                                        double pixel_stddev) {
  std::vector<body::LabelledPoint> points;
  geometry::TriangulationOptions options;
  options.pixel_stddev = pixel_stddev;
  for (std::size_t led = 0; led < body.leds.size(); ++led) {
    std::vector<geometry::Observation> observations;
    for (std::size_t c = 0; c < views.size(); ++c) {
      if (const auto pixel = views[c].pixelAt(time, led))
        observations.push_back({&rig.cameras[c].camera, *pixel});
    }
    if (const auto point = geometry::triangulate(observations, options))
      points.push_back({body.labels[led], point->position, point->covariance});
  }
  return points;
}

/// Whether each light is nearer to its own LED of the tracked body than to any other.
bool isOwn(const body::BodyEstimate& body,
           const geometry::Camera& camera,
           const std::vector<Eigen::Vector2d>& pixels) {
  for (std::size_t light = 0; light < pixels.size(); ++light) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t nearest = pixels.size();
    for (std::size_t led = 0; led < body.leds.size(); ++led) {
      const auto pixel = camera.project(body.leds[led].position);
      if (pixel && (*pixel - pixels[light]).norm() < least) {
        least = (*pixel - pixels[light]).norm();
        nearest = led;
      }
    }
    if (nearest != light)
      return false;
  }
  return true;
}

void print(const body::BodyEstimate& body, double time, bool tracked, std::FILE* file) {
  const Eigen::Vector3d place = body.world_from_body.translation();
  const Eigen::Matrix3d covariance = body.covariance.topLeftCorner<3, 3>();
  std::fprintf(file, "%.9f,%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", time,
               tracked ? "tracked" : "predicted", place.x(), place.y(), place.z(), covariance(0, 0),
               covariance(0, 1), covariance(0, 2), covariance(1, 1), covariance(1, 2),
               covariance(2, 2));
}

/// The body of a line: x, y, z of each LED [m].
body::Constellation readBody(std::istream* input) {
  body::Constellation body;
  body.name = "body";
  std::string line;
  std::getline(*input, line);
  std::istringstream numbers(line);
  for (Eigen::Vector3d led; numbers >> led.x() >> led.y() >> led.z();) {
    body.labels.push_back(std::to_string(body.leds.size()));
    body.leds.push_back(led);
  }
  return body;
}

int run(const std::string& rig_file,
        const std::string& images_file,
        const std::string& table,
        const body::BodyTrackerOptions& options) {
  const geometry::Rig rig = geometry::readRigFile(rig_file);
  std::ifstream input(images_file);
  const body::Constellation body = readBody(&input);
  body::BodyTracker tracker(rig, {body}, options);
  std::vector<View> views(rig.cameras.size());
  std::vector<Eigen::Vector2d> pixels(body.leds.size());
  std::FILE* const output = std::fopen(table.c_str(), "w");
  if (!input || !output)
    throw Error(images_file + " cannot be read, or " + table + " not written");
  std::fputs("time [s],state,x [m],y [m],z [m],cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz\n",
             output);
  std::size_t camera;
  double time;
  while (input >> camera >> time && camera < views.size()) {
    for (Eigen::Vector2d& pixel : pixels)
      input >> pixel.x() >> pixel.y();
    views[camera].add(time, pixels);
    tracker.add(camera, time, pixels);
    const auto& found = tracker.bodies()[0];
    if (found)
      views[camera].misses =
          isOwn(*found, rig.cameras[camera].camera, pixels) ? 0 : views[camera].misses + 1;
    if (views[camera].misses >= kMostMisses) {
      tracker.reset();
      for (View& view : views)
        view.misses = 0;
    }
    if (!found)
      tracker.startFromLabels(locate(rig, views, body, time, options.pixel_stddev));
    // One camera alone hardly tells how far away a small body is.
    const bool tracked = std::count_if(views.begin(), views.end(), [&](const View& view) {
                           return view.last.time >= time - options.tracked_time && !view.misses;
                         }) >= 2;
    if (tracker.bodies()[0])
      print(*tracker.bodies()[0], time, tracked, output);
  }
  std::fclose(output);
  if (!input.eof())
    throw Error(images_file + " has a line that is not camera, time, and x and y of each LED");
  return 0;
}

}  // namespace
}  // namespace wiimote_tracker::import

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  std::string rig, images, table;
  body::BodyTrackerOptions options;
  options.merging_distance = 0.0;
  options.tracked_time = 0.05;    // as of single LEDs
  options.prediction_time = 0.1;  // labelled lights are found again at once
  ArgumentParser parser(
      "track_labelled_body",
      "Tracks a body whose lights are told apart in every image, and writes its positions to TABLE "
      "(CSV).\nIMAGES: a line of x, y, z [m] of each light on the body, then lines of the camera's "
      "number, the\nexposure time [s], in order, and x and y [px] of each light.");
  parser.positional("RIG", &rig);
  parser.positional("IMAGES", &images);
  parser.positional("TABLE", &table);
  parser.option("--pixel-stddev PX", &options.pixel_stddev, 0.001, 100.0, "noise of a spot");
  return parser.run(argc, argv, [&] { return import::run(rig, images, table, options); });
}
