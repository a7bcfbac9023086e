#include "room_trial.h"

#include "simulated_rig.h"

#include <wiimote_tracker_triangulation/geometry/so3.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <cmath>
#include <string>

namespace wiimote_tracker {

namespace {

constexpr double kStep = 0.02;   // Of the simulation [s].
constexpr double kWalked = 3.5;  // Before and after the door [s].
constexpr double kPixel = 0.2;   // [px]
constexpr double kDegree = M_PI / 180.0;

/// Four cameras in a room of 5 m, in its world.
/// @param first_from_world of the room; its door is at the origin of the first world
/// @param side -1: the room is at negative x of the first world, 1: at positive
geometry::Rig roomRig(int side, const Eigen::Isometry3d& first_from_world) {
  geometry::Rig rig = paperRigWith({});
  const std::vector<Eigen::Vector2d> places = {{5.0, -1.0}, {5.0, 2.2}, {3.5, 2.5}, {3.5, -2.5}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    geometry::RigCamera& camera = rig.cameras[i];
    camera.camera.name = (side < 0 ? "hall_" : "lab_") + std::to_string(i + 1);
    camera.camera.identity.clear();
    const Eigen::Isometry3d pose =
        geometry::lookAt({side * places[i].x(), places[i].y(), 2.2},
                         Eigen::Vector3d(side * 1.6, 0.0, 1.0), Eigen::Vector3d::UnitZ());
    camera.camera.world_from_camera = first_from_world.inverse() * pose;
    camera.gravity = 9.81 * pose.linear().row(2).transpose();
  }
  rig.method = "simulated";
  return rig;
}

/// A first-order Gauss-Markov process.
class Wander {
 public:
  Wander(double stddev, double time, square::Random& random)
      : stddev_(stddev), kept_(std::exp(-kStep / time)), value_(square::normal(random, stddev)) {}

  double next(square::Random& random) {
    value_ = kept_ * value_ + square::normal(random, stddev_ * std::sqrt(1.0 - kept_ * kept_));
    return value_;
  }

 private:
  double stddev_, kept_, value_;
};

/// Positions in the first world; time 0: at the door.
rooms::Path carriedPath(bool from_first, const CarriedLed& led, square::Random& random) {
  const double angle = led.direction + (from_first ? 0.0 : M_PI);
  const Eigen::Vector2d ahead(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d goal =
      Eigen::Vector2d(0.0, square::uniform(random, -0.2, 0.2)) + 8.0 * ahead;
  Eigen::Vector2d person = goal - (8.0 + kWalked * led.speed) * ahead;
  const double height = 1.1 + square::normal(random, 0.1);
  Wander heading(led.heading, 0.7, random);
  Wander speed(0.05, 1.0, random);
  std::vector<Wander> hand;
  for (int axis = 0; axis < 3; ++axis)
    hand.emplace_back(0.015, 1.0, random);
  const double stride = 2.0 * M_PI * 0.76 * led.speed;  // Two steps of 0.66 m [rad/s].
  const Eigen::Vector3d phase(square::uniform(random, 0.0, 6.28),
                              square::uniform(random, 0.0, 6.28),
                              square::uniform(random, 0.0, 6.28));
  rooms::Path path;
  for (double time = -kWalked; time < kWalked; time += kStep) {
    const Eigen::Vector2d to = goal - person;
    const double direction = std::atan2(to.y(), to.x()) + heading.next(random);
    const Eigen::Vector2d forward(std::cos(direction), std::sin(direction));
    const Eigen::Vector2d left(-forward.y(), forward.x());
    const double share = std::abs(time) < 0.5 * led.hidden ? 1.0 - led.slowing : 1.0;
    person += share * (led.speed + speed.next(random)) * kStep * forward;
    const Eigen::Vector2d held = person + 0.02 * std::sin(stride * time + phase.x()) * left +
                                 0.01 * std::sin(2.0 * stride * time + phase.y()) * forward;
    Eigen::Vector3d position(held.x(), held.y(),
                             height + 0.02 * std::sin(2.0 * stride * time + phase.z()));
    for (Eigen::Index i = 0; i < 3; ++i)
      position[i] += hand[static_cast<std::size_t>(i)].next(random);
    path.push_back({time, position, 0.0});
  }
  return path;
}

}  // namespace

TwoRooms::TwoRooms(std::uint64_t seed, double slope) : random_(seed) {
  const Eigen::Vector3d tilt(square::normal(random_, slope), square::normal(random_, slope), 0.0);
  first_from_second_ = Eigen::Translation3d(2.0, 0.7, -0.05) * geometry::so3::exp(tilt) *
                       Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ());
  first = roomRig(-1, Eigen::Isometry3d::Identity());
  second = roomRig(1, first_from_second_);
  first_truth_ = drawTruth(first, random_);
  second_truth_ = drawTruth(second, random_);
}

rooms::Path TwoRooms::measured(const geometry::Rig& rig,
                               const std::vector<geometry::RigCamera>& truth,
                               const rooms::Path& path) {
  rooms::Path result;
  for (const rooms::PathPoint& point : path) {
    std::vector<geometry::Observation> observations;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (truth[i].camera.sees(point.position))
        observations.push_back(
            {&rig.cameras[i].camera, *truth[i].camera.project(point.position) +
                                         Eigen::Vector2d(square::normal(random_, kPixel),
                                                         square::normal(random_, kPixel))});
    }
    if (const auto measurement = geometry::triangulate(observations, {}))
      result.push_back(
          {time_ + point.time, measurement->position, measurement->covariance.trace() / 3.0});
  }
  return result;
}

void TwoRooms::carry(bool from_first, const CarriedLed& led) {
  time_ += 30.0;
  rooms::Path seen;
  rooms::Path in_first;
  rooms::Path in_second;
  for (rooms::PathPoint point : carriedPath(from_first, led, random_)) {
    const bool before = point.time < 0.0;
    if (std::abs(point.time) < 0.5 * led.hidden)
      continue;
    point.time += time_;
    seen.push_back(point);
    if (before == from_first) {
      in_first.push_back(point);
    } else {
      point.position = first_from_second_.inverse() * point.position;
      in_second.push_back(point);
    }
  }
  walks.push_back(seen);
  first_tracks.push_back(measured(first, first_truth_, in_first));
  second_tracks.push_back(measured(second, second_truth_, in_second));
}

void TwoRooms::carryOften(int times, const CarriedLed& as) {
  for (int i = 0; i < times; ++i) {
    CarriedLed led = as;
    led.direction = square::uniform(random_, -35.0, 35.0) * kDegree;
    led.speed = square::uniform(random_, 1.0, 1.5);
    carry(i % 2 == 0, led);
  }
}

rooms::JoinedRooms TwoRooms::join(const rooms::JoinOptions& options) const {
  return rooms::joinRooms(first, second, first_tracks, second_tracks, options);
}

std::vector<geometry::RigCamera> TwoRooms::trueCameras() const {
  std::vector<geometry::RigCamera> cameras = first_truth_;
  for (geometry::RigCamera camera : second_truth_) {
    camera.camera.world_from_camera = first_from_second_ * camera.camera.world_from_camera;
    cameras.push_back(camera);
  }
  return cameras;
}

Eigen::Matrix<double, 6, 1> TwoRooms::errorOf(const rooms::JoinedRooms& joined) const {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const geometry::RigCamera& camera : second.cameras)
    middle += camera.camera.center() / static_cast<double>(second.cameras.size());
  Eigen::Matrix<double, 6, 1> error;
  error << geometry::so3::log(first_from_second_.linear() *
                              joined.first_from_second.linear().transpose()),
      first_from_second_ * middle - joined.first_from_second * middle;
  return error;
}

RoomErrors errorsOfRooms(int pairs,
                         const std::function<void(TwoRooms*)>& carry,
                         const rooms::JoinOptions& options,
                         double slope) {
  RoomErrors sum;
  for (int pair = 0; pair < pairs; ++pair) {
    TwoRooms trial(static_cast<std::uint64_t>(pair) + 100, slope);
    carry(&trial);
    const rooms::JoinedRooms joined = trial.join(options);
    const Eigen::Matrix<double, 6, 1> error = trial.errorOf(joined);
    sum.position += error.tail<3>().squaredNorm() / pairs;
    sum.rotation += error.head<3>().squaredNorm() / pairs;
    sum.stated_position += std::pow(joined.position_stddev, 2) / pairs;
    sum.stated_rotation += std::pow(joined.rotation_stddev, 2) / pairs;
    // Of one camera of the second room.
    const std::size_t index = trial.first.cameras.size();
    sum.nees +=
        square::poseNees(joined.rig, index, trial.trueCameras()[index].camera) / 6.0 / pairs;
  }
  return {std::sqrt(sum.position), std::sqrt(sum.rotation), std::sqrt(sum.stated_position),
          std::sqrt(sum.stated_rotation), sum.nees};
}

}  // namespace wiimote_tracker
