#include "remap/measured_points.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>

namespace wiimote_tracker::remap {
namespace {

// An LED that was not carried on is measured within this distance of where it was [m].
constexpr double kUnmoved = 0.01;
// Known places nearer to each other are one [m].
constexpr double kSamePlace = 0.001;
// No correction brings places farther apart than this so near to each other [m].
constexpr double kApart = 0.1;

}  // namespace

void MeasuredPoints::requireNew(const Eigen::Vector3d& known) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if ((known - points_[i].known).norm() < kSamePlace)
      throw Error(
          format("place %zu has these coordinates already: correct them or, if that one is wrong, "
                 "drop the places from %zu on and measure them again",
                 i + 1, i + 1));
  }
}

std::string MeasuredPoints::describeUnmoved(const KnownPoint& point) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if ((point.measured - points_[i].measured).norm() < kUnmoved &&
        (point.known - points_[i].known).norm() > kApart)
      return format("; but the LED is where place %zu was measured: drop the wrong one of the two",
                    i + 1);
  }
  return "";
}

}  // namespace wiimote_tracker::remap
