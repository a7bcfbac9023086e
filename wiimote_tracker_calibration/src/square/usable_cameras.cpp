#include "usable_cameras.h"

#include "square/corner_order.h"
#include "square/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <map>

namespace wiimote_tracker::square {

namespace {

std::vector<std::string> missingCorners(const CameraSightings& camera) {
  std::vector<std::string> missing;
  for (std::size_t c = 0; c < camera.corners.size(); ++c) {
    if (!camera.corners[c])
      missing.push_back(std::to_string(c + 1));
  }
  return missing;
}

CornerOrder orderSeenBy(const CameraSightings& camera) {
  const geometry::Intrinsics& lens = camera.intrinsics;
  std::vector<Eigen::Vector2d> pixels;
  for (std::size_t c = 0; c < camera.corners.size(); ++c) {
    if (!camera.corners[c])
      continue;
    const auto normalized = lens.normalizedFromPixel(*camera.corners[c]);
    if (!normalized)
      throw SquareError("corner " + std::to_string(c + 1) + " lies where the lens of " +
                        camera.name +
                        " cannot image anything: correct the distortion coefficients of its "
                        "starting intrinsics");
    pixels.emplace_back(lens.fx * normalized->x() + lens.cx, lens.fy * normalized->y() + lens.cy);
  }
  return cornerOrder(pixels);
}

std::string refusal(CornerOrder order, const std::string& cameras) {
  switch (order) {
    case CornerOrder::kCoincident:
      return "two corners are in one place as seen by " + cameras +
             ": carry the LED to a new corner before each capture, and place the camera so that no "
             "corner hides behind another";
    case CornerOrder::kCollinear:
      return "three corners are on one line as seen by " + cameras +
             ": put the LED on the four corners of a square, and raise the camera if it looks "
             "along the floor";
    case CornerOrder::kCrossing:
      return "the corners are out of order, the sides of the square cross as seen by " + cameras +
             ": capture the corners one after the other round the square";
    default:
      return "the corners do not look like a square from above as seen by " + cameras +
             ": capture the corners again, round the square";
  }
}

/// Whether the corners go round counter-clockwise seen from above.
/// @throws SquareError: they do not go round a square, or not in all images alike.
bool areCounterClockwise(const std::vector<CameraSightings>& cameras) {
  std::map<CornerOrder, std::vector<std::string>> names;
  for (const CameraSightings& camera : cameras)
    names[orderSeenBy(camera)].push_back(camera.name);
  for (const auto& [order, seeing] : names) {
    if (order != CornerOrder::kCounterClockwise && order != CornerOrder::kClockwise)
      throw SquareError(refusal(order, listOf(seeing)));
  }
  if (names.size() > 1)
    throw SquareError("the corners go round counter-clockwise for " +
                      listOf(names[CornerOrder::kCounterClockwise]) + " but clockwise for " +
                      listOf(names[CornerOrder::kClockwise]) +
                      ": an image is mirrored, a camera is below the floor, or a spot was not the "
                      "LED; check these cameras and capture the corners again");
  return names.count(CornerOrder::kCounterClockwise) > 0;
}

}  // namespace

std::string listOf(const std::vector<std::string>& words) {
  if (words.size() < 2)
    return joined(words);
  return joined(std::vector<std::string>(words.begin(), words.end() - 1)) + " and " + words.back();
}

UsableCameras usableCameras(const std::vector<CameraSightings>& cameras) {
  UsableCameras usable;
  std::array<bool, 4> seen{};
  std::vector<std::string> missing;
  std::size_t complete = 0;
  for (const CameraSightings& camera : cameras) {
    for (std::size_t c = 0; c < seen.size(); ++c)
      seen[c] = seen[c] || camera.corners[c].has_value();
    const std::vector<std::string> corners = missingCorners(camera);
    complete += corners.empty();
    if (corners.empty() || (corners.size() == 1 && camera.gravity))
      usable.cameras.push_back(camera);
    else if (corners.size() == 4)
      missing.push_back(camera.name + " saw no corner");
    else
      missing.push_back(camera.name + " did not see corner " + listOf(corners));
  }
  const auto captured = std::count(seen.begin(), seen.end(), true);
  if (captured < 4)
    throw SquareError("only " + std::to_string(captured) +
                      " of 4 corners are captured: capture the others first");
  if (usable.cameras.size() < 2 || complete < 1) {
    for (const CameraSightings& camera : usable.cameras) {
      if (camera.cornersSeen() < 4)
        missing.push_back(camera.name + " did not see corner " + listOf(missingCorners(camera)));
    }
    if (missing.empty())
      missing.push_back("there is only one camera");
    throw SquareError(
        "at least two cameras must see the square, one all four corners and another four, or three "
        "with its accelerometer, but " +
        listOf(missing) +
        ": turn the cameras so that they see the whole square, or capture those corners again");
  }
  for (const std::string& camera : missing)
    usable.warnings.push_back(camera + " and was left out");
  usable.z_up = areCounterClockwise(usable.cameras);
  if (!usable.z_up)
    usable.warnings.emplace_back(kZDown);
  return usable;
}

}  // namespace wiimote_tracker::square
