#include "intrinsics/view_collector.h"

#include "intrinsics/board_sequence.h"
#include "view_geometry.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::intrinsics {

namespace {

constexpr double kPeriod = 0.25;  // between two readings [s]
// Between views, sum over x, y, size, skew, as in ROS' camera_calibration [0 to 4].
constexpr double kLeastDifference = 0.2;

double unit(double value) {
  return std::clamp(value, 0.0, 1.0);
}

/// 0 if the board touches one edge of the image, 1 if it touches the opposite one.
double placeBetweenEdges(double center, double board, double image) {
  return image > board ? unit((center - board / 2.0) / (image - board)) : 0.5;
}

}  // namespace

ViewCollector::ViewCollector(const Board& board, int width, int height, int minimum_views)
    : samples_{board, width, height, {}}, minimum_views_(minimum_views) {
  for (const double spacing : {board.column_spacing, board.row_spacing}) {
    if (!(std::isfinite(spacing) && spacing > 0.0))
      throw Error("the board's spacings must be above 0 m: measure them");
  }
  if (width < 1 || height < 1)
    throw Error("the image size must be above 0 px: check the camera's driver");
}

bool ViewCollector::addImage(double time, const std::vector<Eigen::Vector2d>& spots) {
  decoder_.add(time, spots);
  const bool set_back = time < next_reading_ - sequence::kCycle - kPeriod;
  if (time < next_reading_ && !set_back)
    return false;
  next_reading_ = time + kPeriod;
  const BoardReading reading = decoder_.read();
  message_ = reading.message;
  if (!reading.view)
    return true;
  const std::string refusal = add(*reading.view);
  if (!refusal.empty()) {
    message_ = refusal;
    return true;
  }
  message_ = "view " + std::to_string(samples_.views.size()) + " is kept (" + reading.message +
             "): hold the board still somewhere else";
  // Keep this message: the next view takes a whole cycle.
  decoder_.clear();
  next_reading_ = time + sequence::kCycle;
  return true;
}

std::string ViewCollector::add(const BoardView& view) {
  Parameters parameters;
  try {
    const ViewGeometry geometry = viewGeometry(samples_.board, view, "this view");
    const Eigen::Vector2d center = geometry.center();
    const double size = geometry.size();
    parameters << placeBetweenEdges(center.x(), size, samples_.width),
        placeBetweenEdges(center.y(), size, samples_.height),
        unit(size / std::sqrt(static_cast<double>(samples_.width) * samples_.height)),
        unit(2.0 * geometry.skew());
  } catch (const Error& error) {
    return error.what();
  }
  for (const Parameters& kept : parameters_) {
    if ((parameters - kept).abs().sum() <= kLeastDifference)
      return "this view is too much like one that was kept: move or tilt the board";
  }
  samples_.views.push_back(view);
  parameters_.push_back(parameters);
  return "";
}

void ViewCollector::undo() {
  if (!samples_.views.empty()) {
    samples_.views.pop_back();
    parameters_.pop_back();
  }
  message_ = "views left: " + std::to_string(samples_.views.size());
}

Coverage ViewCollector::coverage() const {
  Coverage result;
  const int missing_views = minimum_views_ - static_cast<int>(samples_.views.size());
  if (missing_views > 0)
    result.missing.push_back(counted(static_cast<std::size_t>(missing_views), "more view") +
                             " of the board");
  // A small board or one without tilt is not required.
  Parameters low(1.0, 1.0, 0.0, 0.0);
  Parameters high = Parameters::Zero();
  for (const Parameters& kept : parameters_) {
    low = low.min(kept);
    high = high.max(kept);
  }
  const Parameters full(0.7, 0.7, 0.4, 0.5);  // ranges that fill a bar, as in camera_calibration
  result.x = unit((high[0] - low[0]) / full[0]);
  result.y = unit((high[1] - low[1]) / full[1]);
  result.size = unit((high[2] - low[2]) / full[2]);
  result.skew = unit((high[3] - low[3]) / full[3]);
  if (result.x < 1.0)
    result.missing.push_back("show the board at the left and at the right edge of the image");
  if (result.y < 1.0)
    result.missing.push_back("show the board at the top and at the bottom edge of the image");
  if (result.size < 1.0)
    result.missing.push_back("bring the board nearer, until it fills half of the image's width");
  if (result.skew < 1.0)
    result.missing.push_back("tilt the board about its diagonals, to all sides");
  return result;
}

}  // namespace wiimote_tracker::intrinsics
