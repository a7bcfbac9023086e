#pragma once

#include "../rig_subscription.h"
#include "walked_cells.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <ros/node_handle.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <optional>
#include <string>

namespace wiimote_tracker {

/// config/coverage.yaml describes them.
struct CoverageParameters {
  std::optional<Eigen::AlignedBox3d> volume;  ///< World [m]; nothing: volumeOf() the rig.
  double cell_size = 0.5;                     ///< [m]
  double pixel_stddev = 0.5;                  ///< [px]

  /// In words.
  std::string nameOfVolume() const;

  /// @throws ParameterError
  static CoverageParameters read(ParameterReader* reader);
};

/// The box from the floor to the cameras [m].
Eigen::AlignedBox3d volumeOf(const geometry::Rig& rig);

/// Which camera to turn; empty: none, or a person has not said which volume counts.
std::string adviceFor(const geometry::Rig& rig,
                      const geometry::CellGrid& grid,
                      const CoverageParameters& parameters);

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
  ros::Publisher cells_publisher_;
  ros::Publisher volume_publisher_;
  ros::Publisher walk_publisher_;
  RigSubscription rig_;
  ros::Subscriber points_subscriber_;
  ros::WallTimer timer_;

  // Of the rig in use.
  std::string world_frame_;
  WalkedCells walked_;
  std::string possible_;  // what the walk can show at best, and a turn
  bool walk_changed_ = false;
};

}  // namespace wiimote_tracker
