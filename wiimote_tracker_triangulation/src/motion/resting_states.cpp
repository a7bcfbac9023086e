#include "wiimote_tracker_triangulation/motion/resting_states.h"

namespace wiimote_tracker::motion {
namespace {

/// Place of (i, j) in a symmetric block.
constexpr int kSymmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

}  // namespace

void RestingStates::set(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  for (int i = 0; i < 3; ++i) {
    p[i].setConstant(position[i]);
    for (int j = i; j < 3; ++j)
      pp[kSymmetric[i][j]].setConstant(covariance(i, j));
  }
}

void RestingStates::predict(const Pair& variances) {
  for (int i = 0; i < 3; ++i)
    pp[kSymmetric[i][i]] += variances;
}

void RestingStates::update(const Innovations<Pair>& n) {
  // As KinematicStates: W = P H^T L^-T; the covariance becomes P - W W^T.
  std::array<Pair, 3> image_u, image_v, w_u, w_v;
  for (int i = 0; i < 3; ++i) {
    image_u[i] = n.jacobian(0, i) * n.whiten_uu;
    image_v[i] = n.jacobian(0, i) * n.whiten_vu + n.jacobian(1, i) * n.whiten_vv;
  }
  for (int i = 0; i < 3; ++i) {
    const int* s = kSymmetric[i];
    w_u[i] = pp[s[0]] * image_u[0] + pp[s[1]] * image_u[1] + pp[s[2]] * image_u[2];
    w_v[i] = pp[s[0]] * image_v[0] + pp[s[1]] * image_v[1] + pp[s[2]] * image_v[2];
    p[i] += w_u[i] * n.u + w_v[i] * n.v;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j)
      pp[kSymmetric[i][j]] -= w_u[i] * w_u[j] + w_v[i] * w_v[j];
  }
}

void RestingStates::join(const Pair& shares,
                         const Eigen::Vector3d& mean,
                         const Eigen::Matrix3d& covariance) {
  const Pair stays = 1.0 - shares;
  std::array<Pair, 3> d;
  for (int i = 0; i < 3; ++i) {
    d[i] = mean[i] - p[i];
    p[i] += shares * d[i];
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      Pair& to = pp[kSymmetric[i][j]];
      to = stays * to + shares * (covariance(i, j) + stays * d[i] * d[j]);
    }
  }
}

}  // namespace wiimote_tracker::motion
