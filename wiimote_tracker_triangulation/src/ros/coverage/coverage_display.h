#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_COVERAGE_DISPLAY_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_COVERAGE_DISPLAY_H

#include "wiimote_tracker_triangulation/geometry/coverage.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <ros/node_handle.h>
#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// config/coverage.yaml describes them.
struct CoverageParameters {
  std::optional<Eigen::AlignedBox3d> volume;  ///< World [m]; nothing: volumeOf() the rig.
  double cell_size = 0.5;                     ///< [m]
  double pixel_stddev = 0.5;                  ///< [px]

  /// @throws ParameterError
  static CoverageParameters read(ParameterReader* reader);
};

/// The box from the floor to the cameras [m].
Eigen::AlignedBox3d volumeOf(const geometry::Rig& rig);

/// Such as "86 % of the volume is seen by two cameras or more; points are known to 12 mm there
/// (median)."
std::string sentenceOf(const std::vector<geometry::CoverageCell>& cells);

/// Such as " wiimote_3, turned by 15 degrees to the left and 10 degrees up, would make it 94 %."
std::string sentenceOf(const geometry::CameraTurn& turn);

/// A small cube in each cell: red where fewer than two cameras see it, else from green (points are
/// known to 5 mm or better) to yellow (50 mm or worse); and a sentence above them.
visualization_msgs::MarkerArray coverageMarkers(const std::string& world_frame,
                                                const std::vector<geometry::CoverageCell>& cells,
                                                double cell_size,
                                                const std::string& sentence);

/// The same of a walk: a cube where the LED was, red where one camera saw it, yellow for two, green
/// for more.
visualization_msgs::MarkerArray walkMarkers(const std::string& world_frame,
                                            const std::vector<geometry::CoverageCell>& walked,
                                            double cell_size,
                                            const std::string& sentence);

/// Where the cameras of the rig in use have seen an LED.
class WalkedCells {
 public:
  /// @param cells of the grid. What was seen is kept if they are where those of the rig before
  /// were, which a correction of the rig hardly changes.
  void setRig(const std::string& rig_id,
              const geometry::CellGrid& grid,
              const std::vector<geometry::CoverageCell>& cells);

  /// @returns whether this shows something new.
  bool add(const wiimote_tracker_msgs::TrackedPointArray& points);

  /// With the most cameras that saw an LED there at once.
  const std::vector<geometry::CoverageCell>& cells() const { return cells_; }

 private:
  std::string rig_id_;
  std::optional<geometry::CellGrid> grid_;
  std::vector<geometry::CoverageCell> cells_;
};

/// Publishes, latched, the coverage of each new rig and where its cameras have seen an LED since.
class CoverageDisplay {
 public:
  CoverageDisplay(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);

 private:
  void onRig(const wiimote_tracker_msgs::RigCalibration& message);
  void onPoints(const wiimote_tracker_msgs::TrackedPointArray& message);
  void publishWalk();

  ros::NodeHandle nh_;
  CoverageParameters parameters_;
  ros::Publisher publisher_;
  ros::Publisher walk_publisher_;
  ros::Subscriber subscriber_;
  ros::Subscriber points_subscriber_;
  ros::WallTimer timer_;

  // Of the rig in use.
  std::string world_frame_;
  WalkedCells walked_;
  std::string possible_;  // what the walk can show at best, and a turn
  bool walk_changed_ = false;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_COVERAGE_DISPLAY_H
