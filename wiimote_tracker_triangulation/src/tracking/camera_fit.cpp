#include "camera_fit.h"

#include <algorithm>

namespace wiimote_tracker::tracking {

void CameraFit::add(std::size_t shown,
                    std::size_t missing,
                    std::size_t unassigned,
                    std::size_t explained) {
  constexpr double kMemoryOfUsual = 150.0;  // images
  constexpr double kRatio = 1.5;            // misfits per fit of a camera that does not fit
  unassigned_ = unassigned;
  const double surplus = static_cast<double>(unassigned) - usual_;
  if (shown > 0 && missing == 0) {
    complete_images_ = std::min(complete_images_ + 1.0, kMemoryOfUsual);
    usual_ += surplus / complete_images_;
  }
  // Forgets exponentially. An LED that is hidden makes no other spot: only as many are misfits as
  // there are more unassigned spots than usual.
  const double kept = std::max(0.0, 1.0 - static_cast<double>(shown + missing) / limits_.memory);
  fits_ = kept * fits_ + static_cast<double>(shown);
  missing_ = kept * missing_ + static_cast<double>(missing);
  explained_ = kept * explained_ + static_cast<double>(explained);
  misfits_ = std::max(0.0, kept * misfits_ + std::min(static_cast<double>(missing), surplus));
  misfit_ = misfit_ ? misfits_ > limits_.tolerated * fits_
                    : misfits_ >= limits_.least * limits_.memory && misfits_ > kRatio * fits_;
}

}  // namespace wiimote_tracker::tracking
