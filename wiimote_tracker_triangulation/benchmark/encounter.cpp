#include "encounter.h"

#include "wiimote_tracker_triangulation/motion/motion_filter.h"
#include "wiimote_tracker_triangulation/motion/singer_step.h"

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
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Half of a path: from the meeting away in time, either way, sampled.
std::vector<Eigen::Vector3d> wander(geometry::test::Random& random,
                                    const Encounter& encounter,
                                    Eigen::Vector3d p,
                                    Eigen::Vector3d v,
                                    Eigen::Vector3d a,
                                    double interval) {
  const auto noise = [&] {
    const double x = random.gaussian();
    const double y = random.gaussian();
    return Eigen::Vector3d(x, y, random.gaussian());
  };
  const double keep = std::exp(-interval / encounter.acceleration_time);
  std::vector<Eigen::Vector3d> samples = {p};
  for (double t = 0.0; t < encounter.half_duration; t += interval) {
    p += interval * v + 0.5 * interval * interval * a;
    v += interval * a;
    a = keep * a + std::sqrt(1.0 - keep * keep) * encounter.acceleration * noise();
    samples.push_back(p);
  }
  return samples;
}

/// A textbook Kalman filter of the Singer model, linearised at the truth.
class Follower {
 public:
  Follower(const Encounter& encounter, double time, const Eigen::Vector3d& place)
      : encounter_(encounter), time_(time) {
    mean_.head<3>() = place;
    covariance_.diagonal().head<3>().setConstant(1e-2);
    covariance_.diagonal().segment<3>(3).setConstant(4.0);
    covariance_.diagonal().tail<3>().setConstant(encounter.acceleration * encounter.acceleration);
  }

  void predict(double time) {
    const motion::SingerStep step(time - time_, encounter_.acceleration_time);
    const double variance = encounter_.acceleration * encounter_.acceleration;
    Matrix9 transition = Matrix9::Identity();
    Matrix9 noise = Matrix9::Zero();
    for (int i = 0; i < 3; ++i) {
      transition(i, 3 + i) = step.p_v;
      transition(i, 6 + i) = step.p_a;
      transition(3 + i, 6 + i) = step.v_a;
      transition(6 + i, 6 + i) = step.a_a;
      noise(i, i) = variance * step.q_pp;
      noise(i, 3 + i) = noise(3 + i, i) = variance * step.q_pv;
      noise(i, 6 + i) = noise(6 + i, i) = variance * step.q_pa;
      noise(3 + i, 3 + i) = variance * step.q_vv;
      noise(3 + i, 6 + i) = noise(6 + i, 3 + i) = variance * step.q_va;
      noise(6 + i, 6 + i) = variance * step.q_aa;
    }
    mean_ = transition * mean_;
    covariance_ = transition * covariance_ * transition.transpose() + noise;
    time_ = time;
  }

  /// @returns log likelihood of the pixel.
  double update(const geometry::Camera& camera,
                const Eigen::Vector3d& truth,
                const Eigen::Vector2d& pixel,
                double pixel_stddev) {
    Eigen::Matrix<double, 2, 3> jacobian;
    const Eigen::Vector2d at_truth = *camera.project(truth, &jacobian);
    const Eigen::Vector2d innovation = pixel - at_truth - jacobian * (mean_.head<3>() - truth);
    const Eigen::Matrix<double, 9, 2> cross = covariance_.leftCols<3>() * jacobian.transpose();
    const Eigen::Matrix2d spread =
        jacobian * cross.topRows<3>() + pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d inverse = spread.inverse();
    mean_ += cross * inverse * innovation;
    covariance_ -= cross * inverse * cross.transpose();
    covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
    return -0.5 * (innovation.dot(inverse * innovation) + std::log(spread.determinant()));
  }

 private:
  Encounter encounter_;
  double time_;
  Vector9 mean_ = Vector9::Zero();
  Matrix9 covariance_ = Matrix9::Zero();
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

/// @tparam Model what a Follower follows by.
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

std::vector<Path> Encounter::draw(geometry::test::Random& random) const {
  constexpr double kInterval = 0.001;  // [s]
  const auto drawn = [&](double stddev) {
    const double x = random.gaussian();
    const double y = random.gaussian();
    return Eigen::Vector3d(stddev * Eigen::Vector3d(x, y, random.gaussian()));
  };
  const Eigen::Vector3d middle(1.25, 1.25, 1.0);
  std::vector<Path> paths;
  for (int led = 0; led < 2; ++led) {
    // Of two independent ones the difference has twice the variance.
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

std::optional<bool> oracleErrs(const Encounter& encounter,
                               const geometry::Rig& rig,
                               const std::vector<Path>& leds,
                               const std::vector<SceneImage>& images,
                               double pixel_stddev) {
  return errs<Follower>(encounter, rig, leds, images, pixel_stddev);
}

std::optional<bool> oracleErrsWithFilters(const motion::MotionOptions& options,
                                          const geometry::Rig& rig,
                                          const std::vector<Path>& leds,
                                          const std::vector<SceneImage>& images,
                                          double pixel_stddev) {
  return errs<FilterFollower>(options, rig, leds, images, pixel_stddev);
}

}  // namespace wiimote_tracker
