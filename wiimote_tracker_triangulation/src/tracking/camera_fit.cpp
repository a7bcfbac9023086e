#include "camera_fit.h"

#include <algorithm>

namespace wiimote_tracker::tracking {

void CameraFit::add(std::size_t shown, std::size_t missing, std::size_t unassigned) {
  constexpr double kMemoryOfUsual = 150.0;  // images
  constexpr double kRatio = 1.5;
  unassigned_ = unassigned;
  const double surplus = static_cast<double>(unassigned) - usual_;
  if (shown > 0 && missing == 0) {
    complete_images_ = std::min(complete_images_ + 1.0, kMemoryOfUsual);
    usual_ += surplus / complete_images_;
  }
  const double kept = 1.0 - static_cast<double>(shown + missing) / limits_.memory;
  fits_ = kept * fits_ + static_cast<double>(shown);
  misfits_ = std::max(0.0, kept * misfits_ + std::min(static_cast<double>(missing), surplus));
  misfit_ = misfit_ ? misfits_ > limits_.tolerated * fits_
                    : misfits_ >= limits_.least * limits_.memory && misfits_ > kRatio * fits_;
}

void CameraFit::addResidual(const Eigen::Vector2d& velocity, const Eigen::Vector2d& residual) {
  constexpr double kMost = 1000.0;  // spots, of which half are then forgotten
  clock_.count += 1.0;
  clock_.velocity += velocity;
  clock_.residual += residual;
  clock_.squares += velocity.squaredNorm();
  clock_.products += velocity.dot(residual);
  if (clock_.count < kMost)
    return;
  clock_.count *= 0.5;
  clock_.velocity *= 0.5;
  clock_.residual *= 0.5;
  clock_.squares *= 0.5;
  clock_.products *= 0.5;
}

/// With an intercept, so that a constant error of the calibration is none of the clock.
std::optional<double> CameraFit::clockError() const {
  constexpr double kLeastCount = 100.0;
  constexpr double kLeastSquares = 4e6;  // [px^2/s^2]: 0.5 ms if residuals are 1 px
  const double squares = clock_.squares - clock_.velocity.squaredNorm() / clock_.count;
  if (!(clock_.count >= kLeastCount && squares >= kLeastSquares))
    return std::nullopt;
  const double products = clock_.products - clock_.velocity.dot(clock_.residual) / clock_.count;
  return -products / squares;
}

}  // namespace wiimote_tracker::tracking
