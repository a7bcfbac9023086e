#include "led_meeting.h"

#include "motion/motion_filter.h"
#include "motion/transition.h"
#include "single_model_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
  const double keep = std::exp(-interval / meeting.acceleration_time);
  std::vector<Eigen::Vector3d> samples = {p};
  for (double t = 0.0; t < meeting.half_duration; t += interval) {
    p += interval * v + 0.5 * interval * interval * a;
    v += interval * a;
    a = keep * a + std::sqrt(1.0 - keep * keep) * meeting.acceleration * random.gaussianVector(1.0);
    samples.push_back(p);
  }
  return samples;
}

bool isMerged(const SceneImage& image) {
  return std::find(image.leds_of_spot.begin(), image.leds_of_spot.end(), std::uint64_t{3}) !=
         image.leds_of_spot.end();
}

/// The longest run of images that all show one spot: its first image, and the one behind it.
std::pair<std::size_t, std::size_t> longestMerged(const std::vector<SceneImage>& images) {
  std::pair<std::size_t, std::size_t> longest = {0, 0};
  for (std::size_t i = 0; i < images.size();) {
    std::size_t end = i;
    while (end < images.size() && isMerged(images[end]))
      ++end;
    if (end - i > longest.second - longest.first)
      longest = {i, end};
    i = std::max(end, i + 1);
  }
  return longest;
}

/// @param filters of the LEDs, at the first image. @param update gives a filter a pixel, for its
/// log likelihood.
template <typename Filter, typename Update>
bool errs(const MeetingFilm& film,
          const std::pair<std::size_t, std::size_t>& merged,
          std::vector<Filter> filters,
          const Update& update) {
  const auto take = [&](Filter* filter, const SceneImage& image, std::size_t led) {
    double sum = 0.0;
    filter->predict(image.true_time);
    for (std::size_t spot = 0; spot < image.leds_of_spot.size(); ++spot) {
      if (image.leds_of_spot[spot] == std::uint64_t{1} << led)
        sum += update(filter, film.rig.cameras[image.camera].camera, image.image.spots[spot].pixel,
                      film.leds[led](image.true_time));
    }
    return sum;
  };
  for (std::size_t i = 0; i < merged.first; ++i) {
    for (std::size_t led = 0; led < 2; ++led)
      take(&filters[led], film.images[i], led);
  }
  double straight = 0.0;
  double exchanged = 0.0;
  std::vector<Filter> other = filters;
  for (std::size_t i = merged.second; i < film.images.size(); ++i) {
    for (std::size_t led = 0; led < 2; ++led) {
      straight += take(&filters[led], film.images[i], led);
      exchanged += take(&other[led], film.images[i], 1 - led);
    }
  }
  return exchanged > straight;
}

}  // namespace

std::vector<Path> LedMeeting::draw(geometry::test::Random& random) const {
  constexpr double kInterval = 0.001;  // [s]
  const Eigen::Vector3d middle(1.25, 1.25, 1.0);
  std::vector<Path> paths;
  for (int led = 0; led < 2; ++led) {
    // The difference of two independent velocities has twice the variance of one.
    const Eigen::Vector3d p = middle + random.gaussianVector(0.003);
    const Eigen::Vector3d v = random.gaussianVector(relative_speed / std::sqrt(2.0));
    const Eigen::Vector3d a = random.gaussianVector(acceleration);
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

std::optional<OracleErrors> oracleErrors(const LedMeeting& meeting, const MeetingFilm& film) {
  const auto merged = longestMerged(film.images);
  if (merged.second - merged.first < film.rig.cameras.size())
    return std::nullopt;
  const auto model = [&](double duration) {
    return motion::singer(meeting.acceleration, meeting.acceleration_time, duration);
  };
  const double begin = film.images[0].true_time;
  const Eigen::Matrix3d covariance = 1e-2 * Eigen::Matrix3d::Identity();
  const motion::MotionOptions options;
  std::vector<SingleModelFilter> singers;
  std::vector<motion::MotionFilter> filters;
  for (const Path& led : film.leds) {
    singers.push_back({model, film.pixel_stddev, begin,
                       stateAt(led(begin), covariance, 2.0, meeting.acceleration)});
    filters.emplace_back(options, begin, led(begin), covariance);
  }
  using Camera = geometry::Camera;
  using Eigen::Vector2d;
  using Eigen::Vector3d;
  return OracleErrors{
      errs(film, merged, singers,
           [](SingleModelFilter* filter, const Camera& camera, const Vector2d& pixel,
              const Vector3d& truth) { return filter->update(camera, pixel, truth); }),
      errs(film, merged, filters,
           [&](motion::MotionFilter* filter, const Camera& camera, const Vector2d& pixel,
               const Vector3d&) {
             const auto prediction = filter->predictPixel(camera, {film.pixel_stddev, 0.0});
             if (!prediction)
               return -std::numeric_limits<double>::infinity();
             const double likelihood = prediction->logLikelihood(pixel);
             filter->update(camera, *prediction, pixel);
             return likelihood;
           })};
}

}  // namespace wiimote_tracker
