#include "coverage_display.h"

#include "../callbacks.h"
#include "coverage_markers.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <wiimote_tracker_msgs/text.h>

#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

const ros::WallDuration kWalkPeriod(0.5);

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

std::string CoverageParameters::nameOfVolume() const {
  return volume ? "the volume" : "the space from the floor to the cameras";
}

std::string adviceFor(const geometry::Rig& rig,
                      const geometry::CellGrid& grid,
                      const CoverageParameters& parameters) {
  const auto turn =
      parameters.volume ? geometry::bestTurn(rig, grid) : std::optional<geometry::CameraTurn>();
  return turn ? sentenceOf(*turn) : "";
}

CoverageDisplay::CoverageDisplay(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
    : nh_(nh) {
  ParameterReader reader(private_nh);
  parameters_ = CoverageParameters::read(&reader);
  publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("coverage", 1, true);
  cells_publisher_ = nh_.advertise<sensor_msgs::PointCloud2>("coverage/cells", 1, true);
  volume_publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("coverage/volume", 1, true);
  walk_publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("coverage/walk", 1, true);
  rig_.start(nh_, [this](const auto& message) { onRig(message); });
  points_subscriber_ = subscribe<wiimote_tracker_msgs::TrackedPointArray>(
      nh_, "points", 100, [this](const auto& event) { onPoints(*event.getConstMessage()); });
  timer_ = nh_.createWallTimer(kWalkPeriod, [this](const ros::WallTimerEvent&) {
    logExceptions("timer", [this] { publishWalk(); });
  });
}

void CoverageDisplay::onRig(const wiimote_tracker_msgs::RigCalibration& message) {
  try {
    const geometry::Rig rig = fromMessage(message);
    const Eigen::AlignedBox3d volume = parameters_.volume.value_or(volumeOf(rig));
    const geometry::CellGrid grid(volume, parameters_.cell_size);
    const std::vector<geometry::CoverageCell> cells =
        geometry::coverageOf(rig, grid, parameters_.pixel_stddev);
    const std::string advice = adviceFor(rig, grid, parameters_);
    const std::string sentence = sentenceOf(cells, parameters_.nameOfVolume()) + advice;
    cells_publisher_.publish(coverageCloud(rig.world_frame, cells));
    publisher_.publish(coverageMarkers(rig.world_frame, cells, parameters_.cell_size, sentence));
    volume_publisher_.publish(volumeMarkers(rig.world_frame, volume));
    ROS_INFO_STREAM(sentence);
    possible_ = format("; %.0f %% is possible.", 100.0 * geometry::coveredShare(cells)) + advice;
    walked_.setRig(idOf(message, rig), grid, cells);
    world_frame_ = rig.world_frame;
    walk_changed_ = true;
  } catch (const geometry::Error& e) {
    ROS_ERROR("The rig on %s is not used: %s", rig_.topic().c_str(), e.what());
  }
}

void CoverageDisplay::onPoints(const wiimote_tracker_msgs::TrackedPointArray& message) {
  walk_changed_ = walked_.add(message) || walk_changed_;
}

void CoverageDisplay::publishWalk() {
  if (!std::exchange(walk_changed_, false))
    return;
  const std::string sentence = format("Two cameras or more saw the LED in %.0f %% of ",
                                      100.0 * geometry::coveredShare(walked_.cells())) +
                               parameters_.nameOfVolume() + possible_;
  walk_publisher_.publish(
      walkMarkers(world_frame_, walked_.cells(), parameters_.cell_size, sentence));
}

}  // namespace wiimote_tracker
