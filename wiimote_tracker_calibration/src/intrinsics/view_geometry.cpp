#include "view_geometry.h"

#include "adjust/opencv.h"

#include <wiimote_tracker_msgs/error.h>

#include <Eigen/Core>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace wiimote_tracker::intrinsics {

namespace {

// Largest error, as a share of the board's size: distortion bends the mapping by some percent.
constexpr double kLargestError = 0.06;

Eigen::Vector2d mapped(const cv::Mat& homography, const Eigen::Vector3d& point) {
  const cv::Matx33d h(homography.ptr<double>());
  const cv::Vec3d p = h * cv::Vec3d(point.x(), point.y(), 1.0);
  return {p[0] / p[2], p[1] / p[2]};
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double area(const std::array<Eigen::Vector2d, 4>& corners) {
  return 0.5 * cross(corners[2] - corners[0], corners[3] - corners[1]);
}

}  // namespace

Eigen::Vector2d ViewGeometry::center() const {
  return (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
}

double ViewGeometry::size() const {
  return std::sqrt(std::abs(area(corners)));
}

double ViewGeometry::skew() const {
  const Eigen::Vector2d along = corners[0] - corners[1];
  const Eigen::Vector2d down = corners[2] - corners[1];
  return std::abs(M_PI_2 -
                  std::acos(std::clamp(along.normalized().dot(down.normalized()), -1.0, 1.0)));
}

ViewGeometry viewGeometry(const Board& board, const BoardView& view, const std::string& name) {
  std::vector<cv::Point2d> plane;
  std::vector<cv::Point2d> image;
  for (int led = 0; led < kBoardLeds; ++led) {
    const auto& pixel = view.pixels[static_cast<std::size_t>(led)];
    if (!pixel)
      continue;
    if (!pixel->allFinite())
      throw Error(name + " has a pixel that is not a number: leave it out");
    const Eigen::Vector3d p = board.position(led);
    plane.emplace_back(p.x(), p.y());
    image.emplace_back(pixel->x(), pixel->y());
  }
  if (plane.size() < 6)
    throw Error(name + " shows fewer than 6 LEDs: bring more of the board into the image");
  cv::Mat homography;
  if (adjust::fillAnArea(plane) && adjust::fillAnArea(image))
    homography = cv::findHomography(plane, image);
  if (homography.empty())
    throw Error(name +
                " shows LEDs of one line only: bring more of the board into the "
                "image, and do not look along it");

  ViewGeometry geometry;
  constexpr std::array<int, 4> kCorners = {0, 3, 15, 12};
  for (std::size_t i = 0; i < 4; ++i)
    geometry.corners[i] = mapped(homography, board.position(kCorners[i]));
  double sum = 0.0;
  for (int led = 0; led < kBoardLeds; ++led) {
    if (const auto& pixel = view.pixels[static_cast<std::size_t>(led)])
      sum += (mapped(homography, board.position(led)) - *pixel).squaredNorm();
  }
  const double error_px = std::sqrt(sum / static_cast<double>(plane.size()));
  if (!(error_px / std::max(geometry.size(), 1.0) < kLargestError))
    throw Error(name +
                " is no 4 x 4 grid: check that each LED of the board is where its "
                "number says, and that the board is flat");
  if (area(geometry.corners) < 0.0)  // they run counterclockwise
    throw Error(name +
                " is mirrored: LED 0 must be at the top left and LED 3 at the top "
                "right of the board's front; correct its wiring");
  return geometry;
}

}  // namespace wiimote_tracker::intrinsics
