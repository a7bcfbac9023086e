#include "body/body_scene.h"

#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

#include <Eigen/LU>

#include <cmath>

namespace wiimote_tracker::body::test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Constellation fourLeds() {
  return {"four_leds",
          {{0.09, 0.0, 0.03}, {-0.05, 0.085, 0.0}, {-0.06, -0.07, 0.04}, {0.02, 0.03, -0.09}}};
}

Constellation threeLeds() {
  return {"three_leds", {{0.1, 0.0, 0.03}, {-0.06, 0.09, 0.0}, {0.02, -0.03, 0.02}}};
}

Isometry3d randomPose(geometry::test::Random& random, const Vector3d& center) {
  Isometry3d pose = Isometry3d::Identity();
  const Vector3d axis = random.inBox(1.0).normalized();
  pose.linear() = Eigen::AngleAxisd(random.uniform(-M_PI, M_PI), axis).toRotationMatrix();
  pose.translation() = center + random.inBox(0.5);
  return pose;
}

Vector3d noise(geometry::test::Random& random, double stddev) {
  return random.gaussianVector(stddev);
}

Isometry3d handheld(double time) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() =
      Vector3d(1.25 + 0.4 * std::sin(1.3 * time), 1.25 + 0.4 * std::cos(1.1 * time),
               1.1 + 0.2 * std::sin(0.7 * time));
  pose.linear() = (Eigen::AngleAxisd(1.2 * std::sin(0.9 * time), Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.7 * std::sin(1.7 * time), Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

Isometry3d held(double time) {
  constexpr double kTremor = 2.0 * M_PI * 9.0;  // [rad/s]
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() =
      Vector3d(1.25 + 0.006 * std::sin(1.3 * time), 1.25 + 0.006 * std::cos(1.1 * time),
               1.1 + 0.004 * std::sin(0.7 * time) + 5e-5 * std::sin(kTremor * time));
  pose.linear() = (Eigen::AngleAxisd(0.08 * std::sin(1.1 * time), Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.05 * std::sin(1.9 * time) + 5e-4 * std::sin(kTremor * time),
                                     Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

Isometry3d shaken(double time) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() =
      Vector3d(1.25 + 0.1 * std::sin(12.0 * time), 1.25 + 0.08 * std::cos(11.0 * time), 1.1);
  pose.linear() = (Eigen::AngleAxisd(0.4 * std::sin(17.0 * time), Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.4 * std::sin(14.0 * time), Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

Isometry3d tumbling(double time) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.25, 1.25, 1.1);
  pose.linear() =
      Eigen::AngleAxisd(2.0 * M_PI * (time - 1000.0), Vector3d(0.48, 0.6, 0.64)).toRotationMatrix();
  return pose;
}

std::vector<tracking::test::Path> pathsOf(const Constellation& body, const Motion& motion) {
  std::vector<tracking::test::Path> paths;
  for (const Vector3d& led : body.leds)
    paths.push_back([led, motion](double time) { return Vector3d(motion(time) * led); });
  return paths;
}

Vector3d rotationError(const Isometry3d& from, const Isometry3d& to) {
  const Eigen::AngleAxisd difference(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  return difference.angle() * difference.axis();
}

double normalisedError(const Isometry3d& truth,
                       const Isometry3d& found,
                       const PoseCovariance& covariance) {
  Eigen::Matrix<double, 6, 1> error;
  error.head<3>() = found.translation() - truth.translation();
  error.tail<3>() = rotationError(truth, found);
  return geometry::squaredMahalanobis(error, covariance);
}

PoseCovariance boundOf(const geometry::Rig& rig,
                       const Constellation& body,
                       const Isometry3d& pose,
                       double pixel_stddev) {
  PoseCovariance information = PoseCovariance::Zero();
  for (const geometry::RigCamera& camera : rig.cameras) {
    for (const Vector3d& led : body.leds) {
      if (!camera.camera.sees(pose * led))
        continue;
      Eigen::Matrix<double, 2, 6> jacobian;
      for (int k = 0; k < 6; ++k) {
        const double h = 1e-5;
        const auto at = [&](double step) {
          Isometry3d moved = pose;
          if (k < 3)
            moved.translation()(k) += step;
          else
            moved.linear() =
                Eigen::AngleAxisd(step, Vector3d::Unit(k - 3)).toRotationMatrix() * pose.linear();
          return *camera.camera.project(moved * led);
        };
        jacobian.col(k) = (at(h) - at(-h)) / (2.0 * h);
      }
      information += jacobian.transpose() * jacobian / (pixel_stddev * pixel_stddev);
    }
  }
  return information.inverse();
}

FollowedBody::FollowedBody(const geometry::Rig& rig,
                           const Constellation& body,
                           const Motion& motion,
                           const tracking::test::SceneOptions& options,
                           unsigned seed)
    : rig_(rig),
      body_(body),
      motion_(motion),
      pixel_noise_(options.pixel_noise),
      scene_(rig, pathsOf(body, motion), options, seed),
      tracker_(rig, {body}, BodyTrackerOptions()) {}

void take(const tracking::test::SceneImage& image, BodyTracker* tracker) {
  tracking::CameraImage copy = image.image;
  tracker->take(image.camera, {}, &copy);
}

void take(std::size_t camera,
          double time,
          const std::vector<Eigen::Vector2d>& pixels,
          BodyTracker* tracker) {
  tracking::CameraImage image;
  image.stamp = image.arrival = time;
  image.stamp_stddev = 0.0;
  for (const Eigen::Vector2d& pixel : pixels)
    image.spots.push_back({pixel});
  tracker->take(camera, {}, &image);
}

void FollowedBody::show() {
  image_ = scene_.next();
}

void FollowedBody::track() {
  tracker_.take(image_.camera, {}, &image_.image);
}

Vector3d FollowedBody::trueVelocity() const {
  constexpr double kStep = 1e-4;  // [s]
  return (motion_(time() + kStep).translation() - motion_(time() - kStep).translation()) /
         (2.0 * kStep);
}

Vector3d FollowedBody::trueAngularVelocity() const {
  constexpr double kStep = 1e-4;  // [s]
  return rotationError(motion_(time() - kStep), motion_(time() + kStep)) / (2.0 * kStep);
}

void BodyScore::add(const FollowedBody& followed) {
  constexpr double kWrong = 0.35;  // [rad]
  images_ += 1.0;
  if (!followed.estimate())
    return;
  known_ += 1.0;
  const Isometry3d truth = followed.truth();
  const Isometry3d& found = followed.estimate()->world_from_body;
  const double turn = rotationError(truth, found).norm();
  wrong_ += turn > kWrong ? 1.0 : 0.0;
  if (std::fmod(images_, 8.0) != 0.0)
    return;
  judged_ += 1.0;
  const PoseCovariance bound =
      boundOf(followed.rig(), followed.body(), truth, followed.pixelNoise());
  position_ += (found.translation() - truth.translation()).squaredNorm();
  rotation_ += turn * turn;
  position_bound_ += bound.topLeftCorner<3, 3>().trace();
  rotation_bound_ += bound.bottomRightCorner<3, 3>().trace();
  Eigen::Matrix<double, 6, 1> rates;
  rates << followed.estimate()->velocity - followed.trueVelocity(),
      followed.estimate()->angular_velocity - followed.trueAngularVelocity();
  velocity_ += rates.head<3>().squaredNorm();
  angular_velocity_ += rates.tail<3>().squaredNorm();
  nees_ += normalisedError(truth, found, followed.estimate()->covariance.topLeftCorner<6, 6>());
  rates_nees_ += geometry::squaredMahalanobis(
      rates, followed.estimate()->covariance.bottomRightCorner<6, 6>());
}

double BodyScore::position() const {
  return std::sqrt(position_ / judged_);
}

double BodyScore::positionRatio() const {
  return std::sqrt(position_ / position_bound_);
}

double BodyScore::rotation() const {
  return std::sqrt(rotation_ / judged_);
}

double BodyScore::rotationRatio() const {
  return std::sqrt(rotation_ / rotation_bound_);
}

double BodyScore::velocity() const {
  return std::sqrt(velocity_ / judged_);
}

double BodyScore::angularVelocity() const {
  return std::sqrt(angular_velocity_ / judged_);
}

double BodyScore::nees() const {
  return nees_ / (6.0 * judged_);
}

double BodyScore::ratesNees() const {
  return rates_nees_ / (6.0 * judged_);
}

double BodyScore::known() const {
  return known_ / images_;
}

double BodyScore::wrong() const {
  return wrong_ / known_;
}

}  // namespace wiimote_tracker::body::test
