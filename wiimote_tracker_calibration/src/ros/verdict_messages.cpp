#include "verdict_messages.h"

#include <wiimote_tracker_triangulation/ros/message_fields.h>

namespace wiimote_tracker {

using wiimote_tracker_msgs::CalibrationVerdict;
using wiimote_tracker_msgs::CameraVerdict;
using wiimote_tracker_msgs::PrincipalPointTrace;

CalibrationVerdict toMessage(const samples::Verdict& verdict, const geometry::Rig& rig) {
  static_assert(static_cast<int>(samples::Grade::kGood) == CalibrationVerdict::GOOD &&
                    static_cast<int>(samples::Grade::kUsable) == CalibrationVerdict::USABLE &&
                    static_cast<int>(samples::Grade::kRedo) == CalibrationVerdict::REDO,
                "the grades of the core and of the message must agree");
  CalibrationVerdict message;
  message.header.stamp = ros::Time(rig.solved_at);
  message.header.frame_id = rig.world_frame;
  message.rig_id = rig.id();
  message.grade = static_cast<std::uint8_t>(verdict.grade);
  message.text = verdict.text;
  message.redo_corner = verdict.redo_corner ? static_cast<std::int32_t>(*verdict.redo_corner) : -1;
  for (const samples::CameraVerdict& camera : verdict.cameras) {
    CameraVerdict entry;
    entry.name = camera.name;
    entry.residual_px = camera.residual_px;
    entry.residual_m = camera.residual_m;
    entry.inlier_share = camera.inlier_share;
    entry.rotation_stddev = camera.rotation_stddev;
    entry.position_stddev = camera.position_stddev;
    entry.focal_stddev = camera.focal_stddev;
    entry.principal_point_stddev = camera.principal_point_stddev;
    entry.k1_stddev = camera.k1_stddev;
    entry.time_offset_stddev = camera.time_offset_stddev;
    message.cameras.push_back(entry);
  }
  for (const Eigen::Vector3d& place : verdict.predicted_at)
    message.predicted_at.push_back(pointOf(place));
  message.predicted_stddev = verdict.predicted_stddev;
  message.expected_error = verdict.expected_error;
  message.next_expected_error = samples::Verdict::kUnknown;
  if (verdict.next) {
    message.next_measurement = verdict.next->text;
    message.next_expected_error = verdict.next->expected_error;
  }
  return message;
}

PrincipalPointTrace toMessage(const principal_point::Trace& trace, const geometry::Rig& rig) {
  PrincipalPointTrace message;
  message.header.stamp = ros::Time(rig.solved_at);
  message.header.frame_id = rig.world_frame;
  message.cameras = trace.cameras;
  for (const principal_point::Round& round : trace.rounds) {
    message.origin_error.push_back(round.origin_error);
    message.corner_error.push_back(round.corner_error);
    for (const Eigen::Vector2d& point : round.principal_points) {
      message.cx.push_back(point.x());
      message.cy.push_back(point.y());
    }
  }
  message.table = principal_point::table(trace);
  return message;
}

}  // namespace wiimote_tracker
