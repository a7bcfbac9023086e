#include "led_meeting.h"

#include "motion/kinematic_state.h"
#include "motion/motion_filter.h"
#include "motion/transition.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wiimote_tracker {
namespace {

using tracking::test::Path;
using tracking::test::SceneImage;

/// Samples of half a path, from the meeting forward or backward in time.
std::vector<Eigen::Vector3d> wander(geometry::test::Random& random,
                                    const LedMeeting& meeting,
                                    Eigen::Vector3d p,
                                    Eigen::Vector3d v,
                                    Eigen::Vector3d a,
                                    double interval) {
  const auto noise = [&] {
    const double x = random.gaussian();
    const double y = random.gaussian();
    return Eigen::Vector3d(x, y, random.gaussian());
  };
  const double keep = std::exp(-interval / meeting.acceleration_time);
  std::vector<Eigen::Vector3d> samples = {p};
  for (double t = 0.0; t < meeting.half_duration; t += interval) {
    p += interval * v + 0.5 * interval * interval * a;
    v += interval * a;
    a = keep * a + std::sqrt(1.0 - keep * keep) * meeting.acceleration * noise();
    samples.push_back(p);
  }
  return samples;
}

/// An extended Kalman filter of the Singer model, linearised at the truth.
class SingerFollower {
 public:
  SingerFollower(const LedMeeting& meeting, double time, const Eigen::Vector3d& position)
      : meeting_(meeting), time_(time) {
    state_.mean << position, Eigen::Matrix<double, 6, 1>::Zero();
    state_.covariance.setZero();
    state_.covariance.diagonal().head<3>().setConstant(1e-2);
    state_.covariance.diagonal().segment<3>(3).setConstant(4.0);
    state_.covariance.diagonal().tail<3>().setConstant(meeting.acceleration * meeting.acceleration);
  }

  void predict(double time) {
    state_.predict(motion::singer(meeting_.acceleration, meeting_.acceleration_time, time - time_));
    time_ = time;
  }

  /// @returns log likelihood of the pixel.
  double update(const geometry::Camera& camera,
                const Eigen::Vector3d& truth,
                const Eigen::Vector2d& pixel,
                double pixel_stddev) {
    Eigen::Matrix<double, 2, 3> jacobian;
    const Eigen::Vector2d at_truth = *camera.project(truth, &jacobian);
    const Eigen::Vector2d innovation = pixel - at_truth - jacobian * (state_.position() - truth);
    const Eigen::Matrix2d covariance =
        jacobian * state_.positionCovariance() * jacobian.transpose() +
        pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d L = covariance.llt().matrixL();
    const Eigen::Matrix2d whitening = L.inverse();
    state_.update(jacobian, whitening, innovation);
    return -0.5 * (whitening * innovation).squaredNorm() - std::log(L.determinant());
  }

 private:
  LedMeeting meeting_;
  double time_;
  motion::KinematicState state_;
};

/// The tracker's filter.
class FilterFollower {
 public:
  FilterFollower(const motion::MotionOptions& options, double time, const Eigen::Vector3d& place)
      : filter_(options, time, place, 1e-2 * Eigen::Matrix3d::Identity()) {}

  void predict(double time) { filter_.predict(time); }

  double update(const geometry::Camera& camera,
                const Eigen::Vector3d& /*truth*/,
                const Eigen::Vector2d& pixel,
                double pixel_stddev) {
    const auto prediction = filter_.predictPixel(camera, {pixel_stddev, 0.0});
    if (!prediction)
      return -std::numeric_limits<double>::infinity();
    const double result = prediction->logLikelihood(pixel);
    filter_.update(camera, *prediction, pixel);
    return result;
  }

 private:
  motion::MotionFilter filter_;
};

bool isMerged(const SceneImage& image) {
  return std::find(image.leds_of_spot.begin(), image.leds_of_spot.end(), std::uint64_t{3}) !=
         image.leds_of_spot.end();
}

/// @tparam Follower the filter of one LED. @tparam Model its parameters.
template <typename Follower, typename Model>
std::optional<bool> errs(const Model& model,
                         const geometry::Rig& rig,
                         const std::vector<Path>& leds,
                         const std::vector<SceneImage>& images,
                         double pixel_stddev) {
  // The longest run of images that all show one spot.
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < images.size();) {
    std::size_t end = i;
    while (end < images.size() && isMerged(images[end]))
      ++end;
    if (end - i > last - first) {
      first = i;
      last = end;
    }
    i = std::max(end, i + 1);
  }
  if (last - first < rig.cameras.size())
    return std::nullopt;

  std::vector<Follower> followers;
  for (const Path& led : leds)
    followers.emplace_back(model, images[0].true_time, led(images[0].true_time));
  const auto take = [&](Follower* follower, const SceneImage& image, std::size_t led) {
    double sum = 0.0;
    follower->predict(image.true_time);
    for (std::size_t spot = 0; spot < image.leds_of_spot.size(); ++spot) {
      if (image.leds_of_spot[spot] == std::uint64_t{1} << led)
        sum += follower->update(rig.cameras[image.camera].camera, leds[led](image.true_time),
                                image.image.spots[spot].pixel, pixel_stddev);
    }
    return sum;
  };
  for (std::size_t i = 0; i < first; ++i) {
    for (std::size_t led = 0; led < 2; ++led)
      take(&followers[led], images[i], led);
  }
  double straight = 0.0;
  double exchanged = 0.0;
  std::vector<Follower> other = followers;
  for (std::size_t i = last; i < images.size(); ++i) {
    for (std::size_t led = 0; led < 2; ++led) {
      straight += take(&followers[led], images[i], led);
      exchanged += take(&other[led], images[i], 1 - led);
    }
  }
  return exchanged > straight;
}

}  // namespace

std::vector<Path> LedMeeting::draw(geometry::test::Random& random) const {
  constexpr double kInterval = 0.001;  // [s]
  const auto drawn = [&](double stddev) {
    const double x = random.gaussian();
    const double y = random.gaussian();
    return Eigen::Vector3d(stddev * Eigen::Vector3d(x, y, random.gaussian()));
  };
  const Eigen::Vector3d middle(1.25, 1.25, 1.0);
  std::vector<Path> paths;
  for (int led = 0; led < 2; ++led) {
    // The difference of two independent velocities has twice the variance of one.
    const Eigen::Vector3d p = middle + drawn(0.003);
    const Eigen::Vector3d v = drawn(relative_speed / std::sqrt(2.0));
    const Eigen::Vector3d a = drawn(acceleration);
    std::vector<Eigen::Vector3d> samples = wander(random, *this, p, -v, a, kInterval);
    std::reverse(samples.begin(), samples.end());
    const std::vector<Eigen::Vector3d> after = wander(random, *this, p, v, a, kInterval);
    samples.insert(samples.end(), after.begin() + 1, after.end());
    const double start = meeting_time - half_duration;
    const Path path = tracking::test::sampled(samples, kInterval);
    paths.push_back([=](double t) { return path(t - start); });
  }
  return paths;
}

std::optional<bool> oracleErrs(const LedMeeting& meeting,
                               const geometry::Rig& rig,
                               const std::vector<Path>& leds,
                               const std::vector<SceneImage>& images,
                               double pixel_stddev) {
  return errs<SingerFollower>(meeting, rig, leds, images, pixel_stddev);
}

std::optional<bool> oracleErrsWithFilters(const motion::MotionOptions& options,
                                          const geometry::Rig& rig,
                                          const std::vector<Path>& leds,
                                          const std::vector<SceneImage>& images,
                                          double pixel_stddev) {
  return errs<FilterFollower>(options, rig, leds, images, pixel_stddev);
}

}  // namespace wiimote_tracker
