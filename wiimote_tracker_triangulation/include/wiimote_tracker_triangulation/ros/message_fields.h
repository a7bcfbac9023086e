#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <ros/time.h>

#include <Eigen/Geometry>

#include <algorithm>

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

inline Eigen::Quaterniond rotationOf(const geometry_msgs::Quaternion& message) {
  return {message.w, message.x, message.y, message.z};
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

template <int kSize>
using RowMajor = Eigen::Matrix<double, kSize, kSize, Eigen::RowMajor>;

/// @param m square, of fixed size. @param row_major of as many elements.
template <typename Matrix, typename Array>
void setMatrix(const Matrix& m, Array* row_major) {
  Eigen::Map<RowMajor<Matrix::RowsAtCompileTime>>(row_major->data()) = m;
}

/// @param row_major of kSize x kSize elements.
template <int kSize, typename Array>
Eigen::Matrix<double, kSize, kSize> matrixOf(const Array& row_major) {
  return Eigen::Map<const RowMajor<kSize>>(row_major.data());
}

}  // namespace wiimote_tracker
