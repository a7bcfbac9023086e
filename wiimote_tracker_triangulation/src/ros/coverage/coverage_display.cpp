#include "coverage_display.h"

#include "../callbacks.h"
#include "../marker_parts.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker {
namespace {

using geometry::CoverageCell;
using markers::color;
using visualization_msgs::Marker;

constexpr double kGood = 0.005;      // green [m]
constexpr double kBad = 0.05;        // yellow [m]
constexpr double kCubeShare = 0.15;  // of a cell's size
constexpr double kSamePlace = 0.02;  // [m]
const ros::WallDuration kWalkPeriod(0.5);
constexpr double kWalkLogPeriod = 30.0;  // [s]

std_msgs::ColorRGBA colorOf(const CoverageCell& cell) {
  if (std::isnan(cell.stddev))
    return color(0.9f, 0.2f, 0.2f, 0.8f);
  const double share = std::log(cell.stddev / kGood) / std::log(kBad / kGood);
  return color(static_cast<float>(std::clamp(share, 0.0, 1.0)), 0.8f, 0.2f, 0.8f);
}

constexpr double kForEver = 0.0;  // lifetime of a marker

Marker cubesOf(const std::string& world_frame, const std::string& ns, double size) {
  Marker cubes = markers::marker(world_frame, 0.0, kForEver, ns, 0, Marker::CUBE_LIST);
  cubes.scale.x = cubes.scale.y = cubes.scale.z = size;
  return cubes;
}

/// @param height above the cells [m]
Marker textAbove(const std::string& world_frame,
                 const std::string& ns,
                 const std::vector<CoverageCell>& cells,
                 double height,
                 const std::string& words) {
  Marker text = markers::marker(world_frame, 0.0, kForEver, ns, 1, Marker::TEXT_VIEW_FACING);
  text.scale.z = markers::kTextHeight;
  text.color = color(1.0f, 1.0f, 1.0f, 1.0f);
  text.text = words;
  Eigen::AlignedBox3d box;
  for (const CoverageCell& cell : cells)
    box.extend(cell.center);
  text.pose.position =
      pointOf(Eigen::Vector3d(box.center().x(), box.center().y(), box.max().z() + height));
  return text;
}

/// Whether the cells are at the same places, but for what a correction of the rig moves.
bool areSame(const std::vector<CoverageCell>& a, const std::vector<CoverageCell>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const CoverageCell& x, const CoverageCell& y) {
                      return (x.center - y.center).norm() < kSamePlace;
                    });
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

std::string sentenceOf(const geometry::CameraTurn& turn) {
  const auto words = [](double angle, const char* one_way, const char* other) {
    return format("%.0f degrees %s", std::abs(angle) * 180.0 / M_PI, angle < 0.0 ? other : one_way);
  };
  std::vector<std::string> ways;
  if (turn.right != 0.0)
    ways.push_back(words(turn.right, "to the right", "to the left"));
  if (turn.up != 0.0)
    ways.push_back(words(turn.up, "up", "down"));
  return " " + turn.camera + ", turned by " + joined(ways, " and ") +
         format(", would make it %.0f %%.", 100.0 * turn.share);
}

visualization_msgs::MarkerArray coverageMarkers(const std::string& world_frame,
                                                const std::vector<CoverageCell>& cells,
                                                double cell_size,
                                                const std::string& sentence) {
  visualization_msgs::MarkerArray array;
  Marker cubes = cubesOf(world_frame, "coverage", kCubeShare * cell_size);
  for (const CoverageCell& cell : cells) {
    cubes.points.push_back(pointOf(cell.center));
    cubes.colors.push_back(colorOf(cell));
  }
  array.markers = {cubes, textAbove(world_frame, "coverage", cells, cell_size, sentence)};
  return array;
}

visualization_msgs::MarkerArray walkMarkers(const std::string& world_frame,
                                            const std::vector<CoverageCell>& walked,
                                            double cell_size,
                                            const std::string& sentence) {
  visualization_msgs::MarkerArray array;
  Marker cubes = cubesOf(world_frame, "walk", 2.0 * kCubeShare * cell_size);
  for (const CoverageCell& cell : walked) {
    if (cell.cameras == 0)
      continue;
    cubes.points.push_back(pointOf(cell.center));
    cubes.colors.push_back(cell.cameras == 1   ? color(0.9f, 0.2f, 0.2f, 0.8f)
                           : cell.cameras == 2 ? color(1.0f, 0.8f, 0.2f, 0.8f)
                                               : color(0.0f, 0.8f, 0.2f, 0.8f));
  }
  if (cubes.points.empty())
    cubes.action = Marker::DELETE;
  array.markers = {cubes, textAbove(world_frame, "walk", walked, 2.0 * cell_size, sentence)};
  return array;
}

void WalkedCells::setRig(const std::string& rig_id,
                         const geometry::CellGrid& grid,
                         const std::vector<CoverageCell>& cells) {
  const bool keep = areSame(cells_, cells);
  std::vector<CoverageCell> walked = cells;
  for (std::size_t i = 0; i < walked.size(); ++i)
    walked[i].cameras = keep ? cells_[i].cameras : 0;
  cells_ = std::move(walked);
  rig_id_ = rig_id;
  grid_ = grid;
}

bool WalkedCells::add(const wiimote_tracker_msgs::TrackedPointArray& points) {
  using wiimote_tracker_msgs::TrackedPoint;
  if (!grid_ || points.rig_id != rig_id_)
    return false;
  bool changed = false;
  for (const TrackedPoint& point : points.points) {
    // With one camera the place is extrapolated, which is near enough for a cell.
    if (point.state != TrackedPoint::TRACKED && point.state != TrackedPoint::PREDICTED)
      continue;
    const auto cell = grid_->cellAt(vectorOf(point.position));
    if (!cell || cells_[*cell].cameras >= point.rays_used)
      continue;
    cells_[*cell].cameras = point.rays_used;
    changed = true;
  }
  return changed;
}

CoverageDisplay::CoverageDisplay(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
    : nh_(nh) {
  ParameterReader reader(private_nh);
  parameters_ = CoverageParameters::read(&reader);
  publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("coverage", 1, true);
  walk_publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("coverage/walk", 1, true);
  subscriber_ = subscribe<wiimote_tracker_msgs::RigCalibration>(
      nh_, "calibration/rig", 1, [this](const auto& event) { onRig(*event.getConstMessage()); });
  points_subscriber_ = subscribe<wiimote_tracker_msgs::TrackedPointArray>(
      nh_, "points", 100, [this](const auto& event) { onPoints(*event.getConstMessage()); });
  timer_ = nh_.createWallTimer(kWalkPeriod, [this](const ros::WallTimerEvent&) { publishWalk(); });
}

void CoverageDisplay::onRig(const wiimote_tracker_msgs::RigCalibration& message) {
  try {
    const geometry::Rig rig = fromMessage(message);
    const geometry::CellGrid grid(parameters_.volume.value_or(volumeOf(rig)),
                                  parameters_.cell_size);
    const std::vector<CoverageCell> cells =
        geometry::coverageOf(rig, grid, parameters_.pixel_stddev);
    const auto turn = geometry::bestTurn(rig, grid);
    const std::string advice = turn ? sentenceOf(*turn) : "";
    const std::string sentence = sentenceOf(cells) + advice;
    publisher_.publish(coverageMarkers(rig.world_frame, cells, parameters_.cell_size, sentence));
    ROS_INFO_STREAM(sentence);
    possible_ = format("; %.0f %% is possible.", 100.0 * geometry::coveredShare(cells)) + advice;
    walked_.setRig(idOf(message, rig), grid, cells);
    world_frame_ = rig.world_frame;
    walk_changed_ = true;
  } catch (const geometry::Error& e) {
    ROS_ERROR("The rig on %s is not used: %s", subscriber_.getTopic().c_str(), e.what());
  }
}

void CoverageDisplay::onPoints(const wiimote_tracker_msgs::TrackedPointArray& message) {
  walk_changed_ = walked_.add(message) || walk_changed_;
}

void CoverageDisplay::publishWalk() {
  if (!std::exchange(walk_changed_, false))
    return;
  const std::string sentence = format("Two cameras or more saw the LED in %.0f %% of the volume",
                                      100.0 * geometry::coveredShare(walked_.cells())) +
                               possible_;
  walk_publisher_.publish(
      walkMarkers(world_frame_, walked_.cells(), parameters_.cell_size, sentence));
  ROS_INFO_STREAM_DELAYED_THROTTLE(kWalkLogPeriod, sentence);
}

}  // namespace wiimote_tracker
