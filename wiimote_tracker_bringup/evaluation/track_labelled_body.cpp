// Tracks a rigid body whose lights are labelled in every image.

#include "wiimote_tracker_triangulation/body/pose_filter.h"
#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"
#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::evaluation {
namespace {

/// Longest time between two images that tell how the lights move [s].
constexpr double kLongestStep = 0.05;
/// Age of the images that locate the body, as of single LEDs [s].
constexpr double kTrackedTime = 0.05;
/// Age at which the body is lost [s]. Labelled lights are found again at once.
constexpr double kLostTime = 0.1;
/// Greatest squared Mahalanobis distance of an image, the sum over its lights. It is wide, because
/// the errors of a lens are not noise, and no other light can be mistaken for one of the body's.
constexpr double kGate = 100.0;
/// The body is searched for anew after this many images of a camera outside the gate.
constexpr int kMostMisses = 2;
/// Standard deviations of a pose to start from, which the images then correct [m, rad].
constexpr double kStartPlace = 0.1;
constexpr double kStartTurn = 0.5;

struct Image {
  double time = -std::numeric_limits<double>::infinity();  // [s]
  std::vector<Eigen::Vector2d> pixels;                     // in the order of the body's lights
};

/// ",1,2,3"
template <typename Numbers>
std::string cellsOf(const Numbers& numbers) {
  std::string cells;
  for (Eigen::Index i = 0; i < numbers.size(); ++i)
    cells += format(",%.9g", numbers(i));
  return cells;
}

/// What a camera saw last, and before.
struct View {
  Image last;
  Image before;
  int misses = 0;  // images in a row outside the gate

  bool tellsMotion(double time) const {
    return last.time - before.time <= kLongestStep && time - last.time <= kLongestStep;
  }

  Eigen::Vector2d pixelAt(double time, std::size_t light) const {
    const double steps = (time - last.time) / (last.time - before.time);
    return last.pixels[light] + steps * (last.pixels[light] - before.pixels[light]);
  }
};

class LabelledBody {
 public:
  /// @param lights on the body [m].
  LabelledBody(const geometry::Rig& rig,
               const std::vector<Eigen::Vector3d>& lights,
               double pixel_stddev)
      : rig_(rig),
        uncertainty_(rig),
        lights_(lights),
        pixel_stddev_(pixel_stddev),
        views_(rig.cameras.size()) {}

  void add(std::size_t camera, const Image& image) {
    View& view = views_[camera];
    view.before = view.last;
    view.last = image;
    if (filter_) {
      view.misses = follow(camera, image, kGate) ? 0 : view.misses + 1;
      if (view.misses >= kMostMisses || image.time - filter_->time() > kLostTime)
        filter_.reset();
    }
    if (!filter_)
      start(image.time);
  }

  /// A line of the table; empty while the body is lost.
  std::string line(double time) const {
    if (!filter_)
      return "";
    body::PoseFilter now = *filter_;
    now.predict(time);
    const body::PoseState& state = now.state();
    std::vector<std::size_t> cameras;
    for (std::size_t c = 0; c < views_.size(); ++c) {
      if (views_[c].last.time >= time - kTrackedTime && views_[c].misses == 0)
        cameras.push_back(c);
    }
    body::PoseCovariance covariance = state.poseCovariance();
    if (const auto more = uncertainty_.covarianceOf(state.position, cameras.data(), cameras.size()))
      covariance.topLeftCorner<3, 3>() += *more;
    // One camera alone hardly tells how far away a small body is.
    return format("%.9f,%s", time, cameras.size() >= 2 ? "tracked" : "predicted") +
           cellsOf(state.position) + cellsOf(state.rotation.coeffs()) + cellsOf(covariance) + "\n";
  }

 private:
  /// Updates the filter; false, without a change, if the image is outside the gate.
  bool follow(std::size_t camera, const Image& image, double gate) {
    body::PoseFilter next = *filter_;
    next.predict(image.time);
    double distance = 0.0;
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      const auto light = body::predictLed(next.state(), rig_.rayCamera(rig_.cameras[camera]),
                                          lights_[i], {pixel_stddev_, 0.0});
      if (!light)
        return false;
      const Eigen::Vector2d innovation = image.pixels[i] - light->pixel;
      distance += innovation.dot(light->covariance.inverse() * innovation);
      next.update(*light, image.pixels[i]);
    }
    if (!(distance < gate))
      return false;
    filter_ = next;
    return true;
  }

  /// Starts where the lights of two cameras, moved on to one time, are, and repeats the images that
  /// told so.
  void start(double time) {
    std::vector<std::size_t> cameras;
    for (std::size_t c = 0; c < views_.size(); ++c) {
      views_[c].misses = 0;
      if (views_[c].tellsMotion(time))
        cameras.push_back(c);
    }
    std::vector<Eigen::Vector3d> in_world;
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      std::vector<geometry::Observation> seen;
      seen.reserve(cameras.size());
      for (const std::size_t c : cameras)
        seen.push_back({&rig_.cameras[c].camera, views_[c].pixelAt(time, i)});
      const auto point = geometry::triangulate(seen, {});
      if (!point)
        return;
      in_world.push_back(point->position);
    }
    const Eigen::Isometry3d world_from_body = geometry::rigidAlignment(in_world, lights_);
    std::vector<std::pair<std::size_t, const Image*>> images;
    for (const std::size_t c : cameras) {
      images.emplace_back(c, &views_[c].before);
      images.emplace_back(c, &views_[c].last);
    }
    std::sort(images.begin(), images.end(),
              [](auto& a, auto& b) { return a.second->time < b.second->time; });
    body::PoseCovariance covariance = body::PoseCovariance::Zero();
    covariance.diagonal().head<3>().setConstant(kStartPlace * kStartPlace);
    covariance.diagonal().tail<3>().setConstant(kStartTurn * kStartTurn);
    filter_.emplace(motion_, images.front().second->time, world_from_body, covariance);
    const bool all_fit = std::all_of(images.begin(), images.end(), [&](auto& image) {
      return follow(image.first, *image.second, std::numeric_limits<double>::infinity());
    });
    if (!all_fit)
      filter_.reset();
  }

  geometry::Rig rig_;
  geometry::CalibrationUncertainty uncertainty_;
  std::vector<Eigen::Vector3d> lights_;
  double pixel_stddev_;
  body::PoseFilterOptions motion_;
  std::vector<View> views_;
  std::optional<body::PoseFilter> filter_;  // at the last image within the gate
};

/// The lights of the first line: x, y, z of each [m]. @throws Error.
std::vector<Eigen::Vector3d> readLights(const std::string& file, std::istream* input) {
  std::string line;
  std::getline(*input, line);
  std::istringstream numbers(line);
  std::vector<double> values;
  for (double value; numbers >> value;)
    values.push_back(value);
  if (!numbers.eof() || values.empty() || values.size() % 3 != 0)
    throw Error(file + " does not begin with a line of x, y and z [m] of each light on the body");
  std::vector<Eigen::Vector3d> lights;
  for (std::size_t i = 0; i < values.size(); i += 3)
    lights.emplace_back(values[i], values[i + 1], values[i + 2]);
  return lights;
}

int run(const std::string& rig_file,
        const std::string& images_file,
        const std::string& table,
        double pixel_stddev) {
  const geometry::Rig rig = geometry::readRigFile(rig_file);
  std::ifstream input(images_file);
  if (!input)
    throw Error(images_file + " cannot be read: name a file of images");
  const std::vector<Eigen::Vector3d> lights = readLights(images_file, &input);
  if (input.peek() == std::ifstream::traits_type::eof())
    throw Error(images_file +
                " has no image after the lights: add lines of camera, time, and x "
                "and y of each LED");
  LabelledBody body(rig, lights, pixel_stddev);
  std::ofstream output(table);
  if (!output)
    throw Error(table + " cannot be written: choose another place");
  output << "time [s],state,x [m],y [m],z [m],qx,qy,qz,qw";
  for (int i = 0; i < 36; ++i)
    output << ",cov_" << i;  // position [m], then rotation about the world axes [rad]
  output << '\n';
  std::size_t camera = 0;
  Image image;
  image.pixels.resize(lights.size());
  for (std::string line; std::getline(input, line);) {
    std::istringstream numbers(line);
    numbers >> camera >> image.time;
    for (Eigen::Vector2d& pixel : image.pixels)
      numbers >> pixel.x() >> pixel.y();
    if (!numbers || camera >= rig.cameras.size())
      throw Error(images_file + " has a line that is not camera, time, and x and y of each LED");
    body.add(camera, image);
    output << body.line(image.time);
  }
  if (!output.flush())
    throw Error(table + " cannot be written to its end: make room on the disk");
  return 0;
}

}  // namespace
}  // namespace wiimote_tracker::evaluation

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  std::string rig, images, table;
  double pixel_stddev = 0.5;
  ArgumentParser parser(
      "track_labelled_body",
      "Tracks a body whose lights are told apart in every image, and writes its poses to TABLE "
      "(CSV).\nIMAGES: a line of x, y, z [m] of each light on the body, then lines of the camera's "
      "number in RIG, from 0,\nthe exposure time [s], in order, and x and y [px] of each light.");
  parser.positional("RIG", &rig);
  parser.positional("IMAGES", &images);
  parser.positional("TABLE", &table);
  parser.option("--pixel-stddev PX", &pixel_stddev, 0.001, 100.0, "noise of a spot");
  return parser.run(argc, argv, [&] { return evaluation::run(rig, images, table, pixel_stddev); });
}
