// The columns of the tables: CSV and MATLAB files have the same.
#pragma once

#include "ros/measurements/writer.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <wiimote_tracker_msgs/text.h>

#include <cstdint>
#include <iterator>
#include <optional>
#include <string>

namespace wiimote_tracker::measurements {

/// One row of the table of bodies: a body of a message.
struct Pose {
  const wiimote_tracker_msgs::TrackedBodyArray& message;
  const wiimote_tracker_msgs::TrackedBody& body;
};

/// The state of an LED or a body as a word, such as "tracked"; a number if it has none.
inline std::string wordOf(std::uint8_t state) {
  static const char* const kWords[] = {"tentative", "tracked", "predicted", "lost"};
  return state < std::size(kWords) ? kWords[state]
                                   : std::to_string(state);  // of a later version of the message
}

/// Columns of a covariance: its upper triangle. @param size 3: x, y, z; 6: then rotations about
/// them. @param per appended to the units.
inline std::string upperTriangle(const std::string& prefix, int size, const std::string& per) {
  static const char* const kAxes[] = {"x", "y", "z", "rx", "ry", "rz"};
  std::string columns;
  for (int r = 0; r < size; ++r) {
    for (int c = r; c < size; ++c)
      columns += "," + prefix + kAxes[r] + kAxes[c] +
                 (c < 3   ? " [m^2"
                  : r < 3 ? " [m*rad"
                          : " [rad^2") +
                 per + "]";
  }
  return columns.substr(1);
}

/// Gives a table its fields, in the order of the columns, by table->add(name, columns, value): the
/// name of the MATLAB variable, the CSV columns with their units, and a function of a row, which
/// returns bool, a number, a time, a text, a vector or a symmetric matrix.
template <template <typename> class Table>
void addFields(Table<Measurement>* table) {
  using Row = const Measurement&;
  table->add("stamp", "time [s]", [](Row m) { return m.message.header.stamp; });
  table->add("triggered", "triggered", [](Row m) { return m.triggered; });
  table->add("id", "id", [](Row m) { return m.led.id; });
  table->add("label", "label", [](Row m) { return m.led.label; });
  table->add("label_confidence", "label_confidence",
             [](Row m) -> double { return m.led.label_confidence; });
  table->add("label_since", "label_since [s]", [](Row m) {
    return m.led.label_since.isZero() ? std::nullopt : std::optional(m.led.label_since);
  });
  table->add("state", "state", [](Row m) { return wordOf(m.led.state); });
  table->add("position", "x [m],y [m],z [m]", [](Row m) { return vectorOf(m.led.position); });
  table->add("velocity", "vx [m/s],vy [m/s],vz [m/s]",
             [](Row m) { return vectorOf(m.led.velocity); });
  table->add("position_covariance", upperTriangle("cov_", 3, ""),
             [](Row m) { return matrixOf<3>(m.led.position_covariance); });
  table->add("velocity_covariance", upperTriangle("vcov_", 3, "/s^2"),
             [](Row m) { return matrixOf<3>(m.led.velocity_covariance); });
  table->add("rays_used", "rays_used", [](Row m) { return m.led.rays_used; });
  table->add("rays_possible", "rays_possible", [](Row m) { return m.led.rays_possible; });
  table->add("residual", "residual [px]", [](Row m) { return m.led.residual; });
  table->add("last_observed", "last_observed [s]", [](Row m) { return m.led.last_observed; });
  table->add("age", "age [s]", [](Row m) { return m.led.age; });
  table->add("remapped", "remapped", [](Row m) { return m.led.remapped != 0; });
  table->add("frame", "frame", [](Row m) { return m.message.header.frame_id; });
  table->add("rig_id", "rig_id", [](Row m) { return m.message.rig_id; });
  table->add("method", "method", [](Row m) { return m.message.method; });
}

template <template <typename> class Table>
void addFields(Table<Pose>* table) {
  using Row = const Pose&;
  table->add("stamp", "time [s]", [](Row p) { return p.message.header.stamp; });
  table->add("name", "body", [](Row p) { return p.body.name; });
  table->add("state", "state", [](Row p) { return wordOf(p.body.state); });
  table->add("position", "x [m],y [m],z [m]",
             [](Row p) { return vectorOf(p.body.pose.pose.position); });
  table->add("quaternion", "qx,qy,qz,qw", [](Row p) -> Eigen::Vector4d {
    return rotationOf(p.body.pose.pose.orientation).coeffs();
  });
  table->add("velocity", "vx [m/s],vy [m/s],vz [m/s]",
             [](Row p) { return vectorOf(p.body.twist.twist.linear); });
  table->add("angular_velocity", "wx [rad/s],wy [rad/s],wz [rad/s]",
             [](Row p) { return vectorOf(p.body.twist.twist.angular); });
  table->add("pose_covariance", upperTriangle("cov_", 6, ""),
             [](Row p) { return matrixOf<6>(p.body.pose.covariance); });
  table->add("twist_covariance", upperTriangle("vcov_", 6, "/s^2"),
             [](Row p) { return matrixOf<6>(p.body.twist.covariance); });
  table->add("residual", "residual [px]", [](Row p) { return p.body.residual; });
  table->add("last_observed", "last_observed [s]", [](Row p) { return p.body.last_observed; });
  table->add("age", "age [s]", [](Row p) { return p.body.age; });
  table->add("frame", "frame", [](Row p) { return p.message.header.frame_id; });
  table->add("rig_id", "rig_id", [](Row p) { return p.message.rig_id; });
}

}  // namespace wiimote_tracker::measurements
