#include "wiimote_tracker_triangulation/body/body_filter.h"

namespace wiimote_tracker::body {

void BodyFilter::predict(double time, const InertialSamples& samples) {
  const auto* before = std::get_if<InertialFilter>(&filter_);
  if (before && !samples.cover(before->time(), time))
    filter_ = PoseFilter(*motion_, before->time(), before->state());
  if (auto* inertial = std::get_if<InertialFilter>(&filter_))
    inertial->predict(time, samples);
  else
    std::get<PoseFilter>(filter_).predict(time);
}

void BodyFilter::update(const LedPrediction& prediction,
                        const Eigen::Vector2d& pixel,
                        double pixel_stddev,
                        const InertialSamples& samples) {
  std::visit([&](auto& filter) { filter.update(prediction, pixel, pixel_stddev); }, filter_);
  const auto* pose = std::get_if<PoseFilter>(&filter_);
  if (pose && samples.cover(pose->time(), pose->time()))
    filter_ = InertialFilter(*inertial_, pose->time(), pose->state(), samples);
}

const PoseState& BodyFilter::state() const {
  const auto* inertial = std::get_if<InertialFilter>(&filter_);
  return inertial ? inertial->state() : std::get<PoseFilter>(filter_).state();
}

}  // namespace wiimote_tracker::body
