// How well rigid bodies are found and followed: one table per section. With --body FILE that file's
// first body is measured as well (a file of bodies, or one of rpg_monocular_pose_estimator).
#include "benchmark_program.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/body/bodies_file.h"
#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

using body::BodyTracker;
using body::Constellation;
using body::PoseCovariance;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using tracking::test::SceneOptions;
using Motion = std::function<Isometry3d(double)>;

constexpr double kPixelNoise = 0.5;  // [px]
constexpr double kBegin = 1001.0;    // of what counts; the scene begins at 1000 [s]
constexpr double kWrong = 0.35;      // a rotation farther off is of another assignment [rad]

std::vector<Constellation> g_bodies;

Constellation fourLeds() {
  return {"four_leds",
          {{0.09, 0.0, 0.03}, {-0.05, 0.085, 0.0}, {-0.06, -0.07, 0.04}, {0.02, 0.03, -0.09}}};
}

Constellation threeLeds() {
  return {"three_leds", {{0.1, 0.0, 0.03}, {-0.06, 0.09, 0.0}, {0.02, -0.03, 0.02}}};
}

Isometry3d handheld(double t) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.25 + 0.4 * std::sin(1.3 * t), 1.25 + 0.4 * std::cos(1.1 * t),
                                1.1 + 0.2 * std::sin(0.7 * t));
  pose.linear() = (Eigen::AngleAxisd(1.2 * std::sin(0.9 * t), Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.7 * std::sin(1.7 * t), Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

/// 360 degrees per second.
Isometry3d tumbling(double t) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.25, 1.25, 1.1);
  pose.linear() =
      Eigen::AngleAxisd(2.0 * M_PI * (t - 1000.0), Vector3d(0.48, 0.6, 0.64)).toRotationMatrix();
  return pose;
}

geometry::Rig rigOf(std::size_t cameras) {
  geometry::Rig rig = tracking::test::paperRig();
  rig.cameras.resize(cameras);  // two: neighbours, as in the paper
  return rig;
}

std::vector<tracking::test::Path> pathsOf(const Constellation& body, const Motion& pose) {
  std::vector<tracking::test::Path> paths;
  for (const Vector3d& led : body.leds)
    paths.push_back([led, pose](double t) { return Vector3d(pose(t) * led); });
  return paths;
}

Vector3d rotationError(const Isometry3d& from, const Isometry3d& to) {
  const Eigen::AngleAxisd difference(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  return difference.angle() * difference.axis();
}

/// Cramer-Rao bound of a pose seen once by each of the cameras that have LEDs in view.
PoseCovariance boundOf(const geometry::Rig& rig,
                       const Constellation& body,
                       const Isometry3d& pose) {
  PoseCovariance information = PoseCovariance::Zero();
  for (const geometry::RigCamera& camera : rig.cameras) {
    for (const Vector3d& led : body.leds) {
      Eigen::Matrix<double, 2, 3> by_point;
      const Vector3d arm = pose.linear() * led;
      if (!camera.camera.sees(pose * led) || !camera.camera.project(pose * led, &by_point))
        continue;
      Eigen::Matrix3d cross;
      cross << 0.0, -arm.z(), arm.y(), arm.z(), 0.0, -arm.x(), -arm.y(), arm.x(), 0.0;
      Eigen::Matrix<double, 2, 6> jacobian;
      jacobian << by_point, -by_point * cross;
      information += jacobian.transpose() * jacobian / (kPixelNoise * kPixelNoise);
    }
  }
  return information.inverse();
}

/// A body before cameras, image by image.
class Session {
 public:
  Session(const geometry::Rig& rig,
          const Constellation& body,
          const Motion& motion,
          const SceneOptions& options,
          unsigned seed)
      : scene_(rig, pathsOf(body, motion), options, seed),
        tracker_(rig, {body}, body::BodyTrackerOptions()) {}

  void step() {
    const tracking::test::SceneImage& image = scene_.next();
    pixels_.clear();
    for (const tracking::Spot& spot : image.image.spots)
      pixels_.push_back(spot.pixel);
    const auto start = std::chrono::steady_clock::now();
    tracker_.add(image.camera, image.image.stamp, pixels_);
    seconds_.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

  double time() const { return tracker_.time(); }
  const std::optional<body::BodyEstimate>& estimate() const { return tracker_.bodies()[0]; }

  /// Quantile of the time that an image took [s].
  double took(double q) {
    std::sort(seconds_.begin(), seconds_.end());
    return seconds_[static_cast<std::size_t>(q * static_cast<double>(seconds_.size() - 1))];
  }

 private:
  tracking::test::Scene scene_;
  BodyTracker tracker_;
  std::vector<Eigen::Vector2d> pixels_;
  std::vector<double> seconds_;
};

SceneOptions sceneOptions() {
  SceneOptions options;
  options.pixel_noise = kPixelNoise;
  return options;
}

BenchmarkRow measure(const std::string& name,
                     std::size_t cameras,
                     const Constellation& body,
                     const Motion& motion,
                     const SceneOptions& options,
                     const BenchmarkSettings& settings,
                     double judged_from = kBegin) {
  const geometry::Rig rig = rigOf(cameras);
  double position = 0.0, position_bound = 0.0, rotation = 0.0, rotation_bound = 0.0, nees = 0.0;
  double images = 0.0, known = 0.0, right = 0.0, judged = 0.0, median = 0.0;
  for (int run = 0; run < settings.runs; ++run) {
    Session session(rig, body, motion, options, settings.seed + static_cast<unsigned>(run));
    int count = 0;
    while (session.time() < judged_from + 10.0 || std::isinf(session.time())) {
      session.step();
      if (session.time() < judged_from)
        continue;
      ++count;
      images += 1.0;
      if (!session.estimate())
        continue;
      known += 1.0;
      const Isometry3d truth = motion(session.time());
      const Isometry3d& found = session.estimate()->world_from_body;
      const Vector3d turn = rotationError(truth, found);
      right += turn.norm() < kWrong;
      if (count % 8 != 0)
        continue;
      const PoseCovariance bound = boundOf(rig, body, truth);
      Eigen::Matrix<double, 6, 1> error;
      error << found.translation() - truth.translation(), turn;
      position += error.head<3>().squaredNorm();
      rotation += error.tail<3>().squaredNorm();
      position_bound += bound.topLeftCorner<3, 3>().trace();
      rotation_bound += bound.bottomRightCorner<3, 3>().trace();
      const PoseCovariance covariance = session.estimate()->covariance.topLeftCorner<6, 6>();
      nees += error.dot(covariance.ldlt().solve(error)) / 6.0;
      judged += 1.0;
    }
    median += session.took(0.5) / settings.runs;
  }
  return {name,
          {{"position mm", 1e3 * std::sqrt(position / judged)},
           {"/ bound", std::sqrt(position / position_bound)},
           {"rotation deg", 180.0 / M_PI * std::sqrt(rotation / judged)},
           {"/ bound ", std::sqrt(rotation / rotation_bound)},
           {"NEES / 6", nees / judged},
           {"known %", 100.0 * known / images},
           {"right %", 100.0 * right / known},
           {"us per image", 1e6 * median}}};
}

void runAccuracy(const BenchmarkSettings& settings, const RowCallback& row) {
  std::vector<Constellation> bodies = {fourLeds(), threeLeds()};
  bodies.insert(bodies.end(), g_bodies.begin(), g_bodies.end());
  for (const Constellation& body : bodies) {
    for (const std::size_t cameras : {4, 2}) {
      const std::string where = body.name + ", " + std::to_string(cameras) + " cameras, ";
      row(measure(where + "hand-held", cameras, body, handheld, sceneOptions(), settings));
      row(measure(where + "360 deg/s", cameras, body, tumbling, sceneOptions(), settings));
    }
  }
}

void runHidden(const BenchmarkSettings& settings, const RowCallback& row) {
  SceneOptions one_led = sceneOptions();
  one_led.hidden = [](std::size_t, std::size_t led, double) { return led == 2; };
  row(measure("one LED of four hidden", 4, fourLeds(), handheld, one_led, settings));
  SceneOptions one_camera = sceneOptions();
  one_camera.hidden = [](std::size_t camera, std::size_t, double t) {
    return t > kBegin && camera != 1;
  };
  row(measure("one camera left, four LEDs, for 10 s", 4, fourLeds(), handheld, one_camera, settings,
              kBegin + 0.5));
  for (const double merging : {8.0, 12.0, 16.0, 24.0}) {
    SceneOptions merged = sceneOptions();
    merged.merging_distance = merging;
    row(measure("spots within " + std::to_string(static_cast<int>(merging)) + " px are one", 4,
                fourLeds(), handheld, merged, settings));
  }
}

void runRecovery(const BenchmarkSettings& settings, const RowCallback& row) {
  SceneOptions options = sceneOptions();
  constexpr double kPeriod = 2.0, kDark = 1.2;  // [s]
  options.hidden = [=](std::size_t, std::size_t, double t) {
    return std::fmod(t, kPeriod) > kDark;
  };
  for (const auto& [name, motion] : {std::make_pair("hand-held", Motion(handheld)),
                                     std::make_pair("360 deg/s", Motion(tumbling))}) {
    std::vector<double> delays;
    double wrong = 0.0;
    for (int run = 0; run < settings.runs; ++run) {
      Session session(rigOf(4), fourLeds(), motion, options,
                      settings.seed + static_cast<unsigned>(run));
      bool was_lost = false;
      while (session.time() < 1021.0 || std::isinf(session.time())) {
        session.step();
        if (!session.estimate()) {
          was_lost = true;
          continue;
        }
        if (!was_lost)
          continue;
        was_lost = false;
        delays.push_back(std::fmod(session.time(), kPeriod));
        wrong += rotationError(motion(session.time()), session.estimate()->world_from_body).norm() >
                 kWrong;
      }
    }
    std::sort(delays.begin(), delays.end());
    const auto quantile = [&](double q) {
      return 1e3 * delays[static_cast<std::size_t>(q * static_cast<double>(delays.size() - 1))];
    };
    row({name,
         {{"times", static_cast<double>(delays.size())},
          {"median ms", quantile(0.5)},
          {"p95 ms", quantile(0.95)},
          {"worst ms", quantile(1.0)},
          {"wrong %", 100.0 * wrong / static_cast<double>(delays.size())}}});
  }
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  std::vector<char*> others;
  for (int i = 0; i < argc; ++i) {
    if (std::string(argv[i]) != "--body" || i + 1 == argc) {
      others.push_back(argv[i]);
      continue;
    }
    try {
      g_bodies.push_back(body::readBodies(argv[++i]).at(0));
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      return 1;
    }
  }
  return runBenchmark(
      "benchmark_bodies",
      {{"accuracy",
        "Poses at the newest image of cameras that are not synchronised, 0.5 px, 10 s a run; "
        "beside the Cramer-Rao bound of one image by each camera. Right: within 20 degrees.",
        runAccuracy},
       {"hidden", "The same with LEDs hidden, or lights that lie close together one spot.",
        runHidden},
       {"recovery",
        "From when the light comes back after 0.8 s in which all LEDs were hidden until there is a "
        "pose again.",
        runRecovery}},
      static_cast<int>(others.size()), others.data());
}
