// Errors of the pose of a moving rigid body with four LEDs.
#include "program.h"
#include "room.h"

#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include <Eigen/Geometry>

#include <cmath>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kDuration = 8.0;  // of a session [s]
constexpr double kSettled = 3.0;   // start of the score [s]
constexpr double kTurning = 2.0;   // of a body, for its speed [rad/m]

/// Four LEDs whose six distances differ by at least 5 cm. The body is large enough to show four
/// spots at 6 m in most poses.
body::Constellation frame() {
  body::Constellation constellation;
  constellation.name = "frame";
  constellation.leds = {
      {-0.09, -0.01, 0.14}, {0.0, -0.14, -0.17}, {0.26, -0.05, -0.09}, {-0.16, 0.2, 0.13}};
  return constellation;
}

/// Moves through the cube on an undulating circle at a speed [m/s], turning and rocking.
Eigen::Isometry3d poseAt(double time, double speed, double phase) {
  const double angle = phase + speed / 0.6 * time;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(1.25 + 0.6 * std::cos(angle), 1.25 + 0.6 * std::sin(angle),
                                       1.1 + 0.2 * std::sin(0.7 * angle));
  pose.linear() = (Eigen::AngleAxisd(kTurning * speed * time + phase, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.5 * std::sin(1.3 * kTurning * speed * time + phase),
                                     Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

struct Score {
  int looked = 0;                                           // instants
  int known = 0;                                            // instants with a pose
  double position = 0.0, rotation = 0.0;                    // squared errors [m^2, rad^2]
  double position_variance = 0.0, rotation_variance = 0.0;  // as stated [m^2, rad^2]
};

Score follow(const simulation::Description& description,
             double speed,
             double led_size,
             std::uint32_t seed) {
  const body::Constellation constellation = frame();
  const double phase = 1e-3 * (seed % 6283);
  std::vector<Path> paths;
  for (const Eigen::Vector3d& led : constellation.leds)
    paths.push_back([=](double time) { return poseAt(time, speed, phase) * led; });
  RoomOptions options;
  options.led_size = led_size;
  Room room(description, paths, options, seed);
  const std::vector<RoomImage> images = record(&room, kDuration);
  const double lateness = medianLateness(images);
  body::BodyTracker tracker(trueRig(description), {constellation}, {});
  Score score;
  std::vector<Eigen::Vector2d> pixels;
  for (const RoomImage& image : images) {
    pixels.clear();
    for (const tracking::Spot& spot : image.image.spots)
      pixels.push_back(spot.pixel);
    tracker.add(image.camera, image.image.stamp, image.image.stamp_stddev, pixels);
    const double time = tracker.time() - lateness;
    if (time < kSettled)
      continue;
    ++score.looked;
    const auto& estimate = tracker.bodies()[0];
    if (!estimate || !estimate->tracked)
      continue;
    ++score.known;
    const Eigen::Isometry3d truth = poseAt(time, speed, phase);
    const Eigen::Isometry3d& measured = estimate->world_from_body;
    score.position += (measured.translation() - truth.translation()).squaredNorm();
    const Eigen::AngleAxisd off(measured.linear() * truth.linear().transpose());
    score.rotation += off.angle() * off.angle();
    score.position_variance += estimate->covariance.diagonal().head<3>().sum();
    score.rotation_variance += estimate->covariance.diagonal().segment<3>(3).sum();
  }
  return score;
}

void measure(const simulation::Description& all, const Session& session, Table* table) {
  const double degrees = 180.0 / M_PI;
  for (const std::size_t cameras : {std::size_t{2}, all.cameras.size()}) {
    const simulation::Description description = withCameras(all, cameras);
    // A small LED 6 m away covers one or two cells of the sensor. A bright one covers three and
    // soon merges with its neighbour.
    for (const double size : {1.5, 3.0}) {
      for (const double speed : {0.0, 0.5, 1.0, 2.0}) {
        const Score score = follow(description, speed, size, session.seed);
        const auto root_mean = [&](double sum) { return std::sqrt(sum / score.known); };
        *table << session.number << description.cameras.size() << size << speed << kTurning * speed
               << static_cast<double>(score.known) / score.looked << 1e3 * root_mean(score.position)
               << degrees * root_mean(score.rotation) << 1e3 * root_mean(score.position_variance)
               << degrees * root_mean(score.rotation_variance);
      }
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv, "Position and rotation errors of a moving body with four LEDs.",
      {"session", "cameras", "led_size", "speed_m_per_s", "turning_rad_per_s", "known_share",
       "position_rms_mm", "rotation_rms_deg", "predicted_position_mm", "predicted_rotation_deg"},
      wiimote_tracker::monte_carlo::measure);
}
