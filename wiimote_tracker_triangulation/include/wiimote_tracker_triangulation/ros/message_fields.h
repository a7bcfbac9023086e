#ifndef WIIMOTE_TRACKER_TRIANGULATION_ROS_MESSAGE_FIELDS_H
#define WIIMOTE_TRACKER_TRIANGULATION_ROS_MESSAGE_FIELDS_H

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <ros/time.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>

namespace wiimote_tracker {

/// Clamped to 0, the least ros::Time.
inline ros::Time timeOf(double seconds) {
  return ros::Time(std::max(0.0, seconds));
}

/// @param message with x, y and z: Point, Vector3.
template <typename Message>
void setVector(const Eigen::Vector3d& v, Message* message) {
  message->x = v.x();
  message->y = v.y();
  message->z = v.z();
}

inline geometry_msgs::Point pointOf(const Eigen::Vector3d& v) {
  geometry_msgs::Point point;
  setVector(v, &point);
  return point;
}

/// @param message with x, y and z: Point, Vector3.
template <typename Message>
Eigen::Vector3d vectorOf(const Message& message) {
  return {message.x, message.y, message.z};
}

inline void setRotation(const Eigen::Quaterniond& q, geometry_msgs::Quaternion* message) {
  message->w = q.w();
  message->x = q.x();
  message->y = q.y();
  message->z = q.z();
}

/// Whether to publish topics and a transform of a TrackedPoint or TrackedBody: it is tracked, or
/// predicted and `publish_predicted`.
template <typename Message>
bool isPublished(const Message& message, bool publish_predicted) {
  return message.state == Message::TRACKED ||
         (publish_predicted && message.state == Message::PREDICTED);
}

/// @param row_major of as many elements as the matrix has.
template <typename Matrix, typename Array>
void setMatrix(const Matrix& m, Array* row_major) {
  std::size_t i = 0;
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    for (Eigen::Index c = 0; c < m.cols(); ++c)
      (*row_major)[i++] = m(r, c);
  }
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_ROS_MESSAGE_FIELDS_H
