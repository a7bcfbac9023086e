#include "wiimote_tracker_calibration/health/drift_watch.h"

#include "residual_mean.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>

#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::health {

namespace {

constexpr double kSamplePeriod = 0.05;  // [s]
// Images that come later than this have no part in the sample.
constexpr double kPatience = 0.1;  // [s]
// Between two images further apart the LED's way is not known.
constexpr double kLongestGap = 0.05;  // [s]
// The clock has jumped.
constexpr double kJump = 1.0;  // [s]
// A still LED gives the same rounding again and again: the next sample is somewhere else.
constexpr double kNextPlace = 2.0;  // [px]
// How far off a time may be, and how far that may shift a spot.
constexpr double kClockKnown = 0.0005;   // [s]
constexpr double kClockUnknown = 0.005;  // [s]
constexpr double kLargestShift = 0.5;    // [px]
// Judgements within the window.
constexpr double kJudgements = 12.0;
constexpr double kNoDrift = 0.0;

/// What geometry::triangulate() makes of it all is a point without regard to how far the rays miss
/// each other: that is judged here.
std::optional<Eigen::Vector3d> pointOf(const std::vector<geometry::Sight>& sights) {
  const auto point = geometry::triangulate(sights.data(), sights.size(), {});
  if (!point)
    return std::nullopt;
  return point->position;
}

}  // namespace

DriftWatch::DriftWatch(const geometry::Rig& rig, const DriftOptions& options)
    : rig_(rig), options_(options), drifts_(rig.cameras.size()) {
  for (const geometry::RigCamera& camera : rig_.cameras)
    cameras_.push_back({rig_.rayCamera(camera), {}, false, std::nullopt});
}

bool DriftWatch::add(const capture::Image& image) {
  const auto found = std::find_if(cameras_.begin(), cameras_.end(), [&](const Camera& camera) {
    return camera.rays.name == image.camera;
  });
  if (found == cameras_.end() || rig_.ray_model != geometry::RayModel::kCalibrated)
    return false;
  const geometry::RigCamera& calibrated =
      rig_.cameras[static_cast<std::size_t>(found - cameras_.begin())];
  using geometry::TimeOffsetRule;
  found->clock_known = calibrated.time_offset_rule == TimeOffsetRule::kAlways ||
                       (calibrated.time_offset_rule == TimeOffsetRule::kOneEpoch &&
                        calibrated.time_offset_epoch == image.clock_epoch);
  Frame frame;
  frame.time = image.stamp + (found->clock_known ? calibrated.time_offset : 0.0);
  if (image.spots.size() == 1)
    frame.pixel = image.spots.front();
  if (!std::isfinite(frame.time))
    return false;
  if (!started_ || std::abs(frame.time - newest_) > options_.window + kJump ||
      frame.time < newest_ - kJump) {
    restart();
    started_ = true;
    newest_ = frame.time;
    next_sample_ = frame.time;
    next_judgement_ = frame.time + options_.window / kJudgements;
  }
  if (found->frames.empty() || frame.time > found->frames.newest().time)
    found->frames.push(frame);
  newest_ = std::max(newest_, frame.time);
  sampleUntil(newest_ - kPatience);
  if (newest_ < next_judgement_)
    return false;
  next_judgement_ = newest_ + options_.window / kJudgements;
  judge();
  return true;
}

void DriftWatch::restart() {
  for (Camera& camera : cameras_) {
    camera.frames.clear();
    camera.last_sample.reset();
  }
  samples_.clear();
  drifts_.assign(cameras_.size(), std::nullopt);
}

void DriftWatch::sampleUntil(double time) {
  if (next_sample_ < time - kJump)
    next_sample_ = time;
  for (; next_sample_ <= time; next_sample_ += kSamplePeriod)
    sampleAt(next_sample_);
  while (!samples_.empty() && samples_.front().time < time - options_.window)
    samples_.pop_front();
}

void DriftWatch::sampleAt(double time) {
  Sample sample{time, {}};
  bool somewhere_else = false;
  std::vector<std::optional<Eigen::Vector2d>> pixels(cameras_.size());
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    Camera& camera = cameras_[i];
    camera.frames.forgetBefore(time);
    const auto bracket = camera.frames.bracket(time);
    if (!bracket || bracket->gap() > kLongestGap || !bracket->before->pixel ||
        !bracket->after->pixel)
      continue;
    const Eigen::Vector2d way = *bracket->after->pixel - *bracket->before->pixel;
    const Eigen::Vector2d pixel = *bracket->before->pixel + bracket->shareAt(time) * way;
    if (bracket->gap() > 0.0) {
      const double speed = way.norm() / bracket->gap();
      if (speed * (camera.clock_known ? kClockKnown : kClockUnknown) > kLargestShift)
        continue;
    }
    const auto sight = geometry::sightFromPixel(camera.rays, pixel);
    if (!sight)
      continue;
    pixels[i] = pixel;
    somewhere_else =
        somewhere_else || !camera.last_sample || (pixel - *camera.last_sample).norm() > kNextPlace;
    sample.sights.emplace_back(i, *sight);
  }
  if (sample.sights.size() < 2 || !somewhere_else)
    return;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (pixels[i])
      cameras_[i].last_sample = pixels[i];
  }
  samples_.push_back(std::move(sample));
}

std::optional<Drift> DriftWatch::driftAgainst(const Cameras& active, std::size_t camera) const {
  std::vector<Residual> residuals;
  const std::size_t stride = samples_.size() / kDerivatives + 1;
  std::size_t number = 0;
  std::vector<std::size_t> others;
  std::vector<geometry::Sight> sights;
  for (const Sample& sample : samples_) {
    const geometry::Sight* own = nullptr;
    others.clear();
    sights.clear();
    for (const auto& sight : sample.sights) {
      if (sight.first == camera) {
        own = &sight.second;
      } else if (active[sight.first]) {
        others.push_back(sight.first);
        sights.push_back(sight.second);
      }
    }
    if (own == nullptr || others.size() < 2)
      continue;
    const auto point = pointOf(sights);
    if (!point || !(own->depth(*point) > 0.0))
      continue;
    Residual residual{own->residual(*point), {}};
    if (number++ % stride == 0 && geometry::hasCovariance(rig_)) {
      // The others' errors move the point, and with it the prediction.
      const auto of_own = geometry::rayProjection(rig_, camera, *point);
      Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
      Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3, rig_.covariance.rows());
      bool complete = of_own.has_value();
      for (const std::size_t other : others) {
        const auto projection = geometry::rayProjection(rig_, other, *point);
        complete = complete && projection;
        if (!complete)
          break;
        information += projection->by_point.transpose() * projection->by_point;
        right.middleCols<geometry::kParameters>(geometry::firstParameter(other)) =
            projection->by_point.transpose() * projection->by_parameters;
      }
      if (complete) {
        residual.by_parameters = -of_own->by_point * (information.inverse() * right);
        residual.by_parameters.middleCols<geometry::kParameters>(
            geometry::firstParameter(camera)) += of_own->by_parameters;
      }
    }
    residuals.push_back(std::move(residual));
  }
  return meanOf(residuals, rig_.covariance, 2, options_.limit);
}

std::optional<Drift> DriftWatch::driftOfPair(std::size_t a, std::size_t b) const {
  std::vector<Residual> residuals;
  const std::size_t stride = samples_.size() / kDerivatives + 1;
  std::size_t number = 0;
  for (const Sample& sample : samples_) {
    std::vector<geometry::Sight> sights;
    for (const auto& sight : sample.sights) {
      if (sight.first == a || sight.first == b)
        sights.push_back(sight.second);
    }
    if (sights.size() < 2)
      continue;
    const auto point = pointOf(sights);
    if (!point)
      continue;
    // The one direction of the four pixels that no point explains: across the epipolar lines. Its
    // sign is that of the epipolar plane, which turns slowly as the LED moves.
    Eigen::Matrix<double, 4, 3> by_point;
    Eigen::Vector4d residual;
    for (Eigen::Index i = 0; i < 2; ++i) {
      const geometry::Sight& sight = sights[static_cast<std::size_t>(i)];
      residual.segment<2>(2 * i) = sight.residual(*point);
      by_point.middleRows<2>(2 * i) = sight.pixel_by_offset / sight.depth(*point);
    }
    const Eigen::HouseholderQR<Eigen::Matrix<double, 4, 3>> qr(by_point);
    const Eigen::Matrix4d q = qr.householderQ() * Eigen::Matrix4d::Identity();
    Eigen::Vector4d across = q.col(3);
    const Eigen::Vector3d normal = (sights[1].origin - sights[0].origin).cross(sights[0].direction);
    if (across.head<2>().dot(sights[0].pixel_by_offset * normal) < 0.0)
      across = -across;
    // In one camera's pixels: both share what one of them is off.
    across *= std::sqrt(2.0);
    Residual result{Eigen::Vector2d(across.dot(residual), 0.0), {}};
    if (number++ % stride == 0 && geometry::hasCovariance(rig_)) {
      const auto first = geometry::rayProjection(rig_, std::min(a, b), *point);
      const auto second = geometry::rayProjection(rig_, std::max(a, b), *point);
      if (first && second) {
        result.by_parameters = Eigen::MatrixXd::Zero(2, rig_.covariance.rows());
        result.by_parameters.block<1, geometry::kParameters>(
            0, geometry::firstParameter(std::min(a, b))) =
            across.head<2>().transpose() * first->by_parameters;
        result.by_parameters.block<1, geometry::kParameters>(
            0, geometry::firstParameter(std::max(a, b))) =
            across.tail<2>().transpose() * second->by_parameters;
      }
    }
    residuals.push_back(std::move(result));
  }
  return meanOf(residuals, rig_.covariance, 1, options_.limit);
}

/// How badly some cameras fit together: the largest of their ratios.
double DriftWatch::worstOf(const Cameras& active) const {
  double worst = kNoDrift;
  for (std::size_t a = 0; a < active.size(); ++a) {
    if (!active[a])
      continue;
    const auto drift = driftAgainst(active, a);
    if (drift) {
      worst = std::max(worst, drift->ratio);
      continue;
    }
    for (std::size_t b = 0; b < active.size(); ++b) {
      const auto pair = active[b] && b != a ? driftOfPair(a, b) : std::nullopt;
      worst = pair ? std::max(worst, pair->ratio) : worst;
    }
  }
  return worst;
}

void DriftWatch::judge() {
  drifts_.assign(cameras_.size(), std::nullopt);
  Cameras active(cameras_.size(), true);
  // A camera that drifted pulls the others' points along, so that these look drifted too: the one
  // is taken out without which the rest fit best, and the rest judged without it.
  bool settled = false;
  while (!settled) {
    settled = true;
    double least = 0.0;
    std::optional<std::size_t> culprit;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      if (!active[i])
        continue;
      drifts_[i] = driftAgainst(active, i);
      if (!drifts_[i] || drifts_[i]->ratio < 1.0)
        continue;
      Cameras rest = active;
      rest[i] = false;
      const double worst = worstOf(rest);
      if (!culprit || worst < least) {
        least = worst;
        culprit = i;
      }
    }
    if (culprit) {
      active[*culprit] = false;
      settled = false;
    }
  }
  // Cameras that share their view with one other only.
  for (std::size_t a = 0; a < cameras_.size(); ++a) {
    for (std::size_t b = a + 1; b < cameras_.size(); ++b) {
      if (!active[a] || !active[b] || (drifts_[a] && drifts_[b]))
        continue;
      auto pair = driftOfPair(a, b);
      if (!pair)
        continue;
      for (const std::size_t i : {a, b}) {
        const std::size_t other = i == a ? b : a;
        // One that the others vouch for is not to blame.
        if (drifts_[i] && drifts_[i]->together.empty())
          continue;
        if (!drifts_[i] || drifts_[i]->ratio < pair->ratio) {
          drifts_[i] = pair;
          drifts_[i]->together = cameras_[other].rays.name;
        }
      }
    }
  }
}

}  // namespace wiimote_tracker::health
