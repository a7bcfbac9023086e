#include "coverage_display.h"

#include "../callbacks.h"
#include "../marker_parts.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker {
namespace {

using geometry::CoverageCell;
using markers::color;
using visualization_msgs::Marker;

constexpr double kGood = 0.005;      // green [m]
constexpr double kBad = 0.05;        // yellow [m]
constexpr double kCubeShare = 0.15;  // of a cell's size

std_msgs::ColorRGBA colorOf(const CoverageCell& cell) {
  if (std::isnan(cell.stddev))
    return color(0.9f, 0.2f, 0.2f, 0.8f);
  const double share = std::log(cell.stddev / kGood) / std::log(kBad / kGood);
  return color(static_cast<float>(std::clamp(share, 0.0, 1.0)), 0.8f, 0.2f, 0.8f);
}

}  // namespace

CoverageParameters CoverageParameters::read(ParameterReader* reader) {
  CoverageParameters p;
  const auto volume = reader->optional<std::vector<double>>("volume", {});
  if (!volume.empty()) {
    if (volume.size() != 6)
      throw ParameterError(reader->nameOf("volume") +
                           " must be [x, y, z, x, y, z]: two opposite corners in metres");
    const Eigen::Map<const Eigen::Vector3d> first(volume.data()), second(volume.data() + 3);
    p.volume = Eigen::AlignedBox3d(first.cwiseMin(second), first.cwiseMax(second));
  }
  reader->read("cell_size", &p.cell_size, 0.05, 10.0);
  reader->read("pixel_stddev", &p.pixel_stddev, 0.01, 100.0);
  reader->refuseUnknown();
  return p;
}

Eigen::AlignedBox3d volumeOf(const geometry::Rig& rig) {
  Eigen::AlignedBox3d box;
  for (const geometry::RigCamera& camera : rig.cameras) {
    const Eigen::Vector3d center = camera.camera.center();
    box.extend(center);
    box.extend(Eigen::Vector3d(center.x(), center.y(), 0.0));
  }
  return box;
}

std::string sentenceOf(const std::vector<CoverageCell>& cells) {
  std::vector<double> known;
  for (const CoverageCell& cell : cells) {
    if (!std::isnan(cell.stddev))
      known.push_back(cell.stddev);
  }
  std::string text = format("%.0f %% of the volume is seen by two cameras or more",
                            100.0 * geometry::coveredShare(cells));
  if (known.empty())
    return text + ".";
  const auto median = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), median, known.end());
  return text + format("; points are known to %.0f mm there (median).", 1e3 * *median);
}

visualization_msgs::MarkerArray coverageMarkers(const std::string& world_frame,
                                                const std::vector<CoverageCell>& cells,
                                                double cell_size) {
  constexpr double kForEver = 0.0;
  visualization_msgs::MarkerArray array;
  Marker cubes = markers::marker(world_frame, 0.0, kForEver, "coverage", 0, Marker::CUBE_LIST);
  cubes.scale.x = cubes.scale.y = cubes.scale.z = kCubeShare * cell_size;
  Marker text =
      markers::marker(world_frame, 0.0, kForEver, "coverage", 1, Marker::TEXT_VIEW_FACING);
  text.scale.z = markers::kTextHeight;
  text.color = color(1.0f, 1.0f, 1.0f, 1.0f);
  text.text = sentenceOf(cells);
  Eigen::AlignedBox3d box;
  for (const CoverageCell& cell : cells) {
    cubes.points.push_back(pointOf(cell.center));
    cubes.colors.push_back(colorOf(cell));
    box.extend(cell.center);
  }
  text.pose.position =
      pointOf(Eigen::Vector3d(box.center().x(), box.center().y(), box.max().z() + cell_size));
  array.markers = {cubes, text};
  return array;
}

CoverageDisplay::CoverageDisplay(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
    : nh_(nh) {
  ParameterReader reader(private_nh);
  parameters_ = CoverageParameters::read(&reader);
  publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("coverage", 1, true);
  subscriber_ = subscribe<wiimote_tracker_msgs::RigCalibration>(
      nh_, "calibration/rig", 1, [this](const auto& event) { onRig(*event.getConstMessage()); });
}

void CoverageDisplay::onRig(const wiimote_tracker_msgs::RigCalibration& message) {
  try {
    const geometry::Rig rig = fromMessage(message);
    const auto cells = geometry::coverageOf(rig, parameters_.volume.value_or(volumeOf(rig)),
                                            parameters_.cell_size, parameters_.pixel_stddev);
    publisher_.publish(coverageMarkers(rig.world_frame, cells, parameters_.cell_size));
    ROS_INFO_STREAM(sentenceOf(cells));
  } catch (const geometry::Error& e) {
    ROS_ERROR("The rig on %s is not used: %s", subscriber_.getTopic().c_str(), e.what());
  }
}

}  // namespace wiimote_tracker
