#include "wiimote_tracker_triangulation/motion/kinematic_state.h"

#include <cmath>

namespace wiimote_tracker::motion {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;
using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// target -= left * right^T
void subtractOuter(const Matrix32& left, const Matrix32& right, Matrix3* target) {
  for (int column = 0; column < 3; ++column)
    target->col(column) -= right(column, 0) * left.col(0) + right(column, 1) * left.col(1);
}

}  // namespace

double Innovation::logLikelihood() const {
  return std::log(whiten(0, 0) * whiten(1, 1)) - 0.5 * whitened.squaredNorm() -
         std::log(2.0 * M_PI);
}

Matrix2 whitening(const Matrix23& jacobian,
                  const Matrix3& position_covariance,
                  const Matrix2& pixel_covariance) {
  const Matrix32 gain = position_covariance * jacobian.transpose();
  const Matrix2 covariance = jacobian * gain + pixel_covariance;
  const double l00 = std::sqrt(covariance(0, 0));
  const double l10 = covariance(1, 0) / l00;
  const double l11 = std::sqrt(covariance(1, 1) - l10 * l10);
  Matrix2 inverse;
  inverse << 1.0 / l00, 0.0, -l10 / (l00 * l11), 1.0 / l11;
  return inverse;
}

void KinematicState::predict(const SingerStep& step, double variance) {
  p += step.p_v * v + step.p_a * a;
  v += step.v_a * a;
  a *= step.a_a;

  // F P F^T, first the rows, then the columns.
  pp += step.p_v * pv.transpose() + step.p_a * pa.transpose();
  pv += step.p_v * vv + step.p_a * va.transpose();
  pa += step.p_v * va + step.p_a * aa;
  vv += step.v_a * va.transpose();
  va += step.v_a * aa;
  pp += step.p_v * pv + step.p_a * pa;
  pv += step.v_a * pa;
  vv += step.v_a * va;
  pa *= step.a_a;
  va *= step.a_a;
  aa *= step.a_a * step.a_a;

  pp.diagonal().array() += variance * step.q_pp;
  pv.diagonal().array() += variance * step.q_pv;
  pa.diagonal().array() += variance * step.q_pa;
  vv.diagonal().array() += variance * step.q_vv;
  va.diagonal().array() += variance * step.q_va;
  aa.diagonal().array() += variance * step.q_aa;
}

void KinematicState::update(const Innovation& innovation) {
  // With S = L L^T and W = P H^T L^-T: gain times innovation is W L^-1 innovation, and the
  // covariance becomes P - W W^T.
  const Matrix32 image = innovation.jacobian.transpose() * innovation.whiten.transpose();
  const Matrix32 w_p = pp * image;
  const Matrix32 w_v = pv.transpose() * image;
  const Matrix32 w_a = pa.transpose() * image;
  p += w_p * innovation.whitened;
  v += w_v * innovation.whitened;
  a += w_a * innovation.whitened;
  subtractOuter(w_p, w_p, &pp);
  subtractOuter(w_p, w_v, &pv);
  subtractOuter(w_p, w_a, &pa);
  subtractOuter(w_v, w_v, &vv);
  subtractOuter(w_v, w_a, &va);
  subtractOuter(w_a, w_a, &aa);
}

void KinematicState::addMean(double weight, const KinematicState& other) {
  p += weight * other.p;
  v += weight * other.v;
  a += weight * other.a;
}

void KinematicState::addCovariance(double weight, const KinematicState& other) {
  const Vector3 d_p = other.p - p;
  const Vector3 d_v = other.v - v;
  const Vector3 d_a = other.a - a;
  pp += weight * (other.pp + d_p * d_p.transpose());
  pv += weight * (other.pv + d_p * d_v.transpose());
  pa += weight * (other.pa + d_p * d_a.transpose());
  vv += weight * (other.vv + d_v * d_v.transpose());
  va += weight * (other.va + d_v * d_a.transpose());
  aa += weight * (other.aa + d_a * d_a.transpose());
}

void KinematicState::setMeanZero() {
  p.setZero();
  v.setZero();
  a.setZero();
}

void KinematicState::setCovarianceZero() {
  pp.setZero();
  pv.setZero();
  pa.setZero();
  vv.setZero();
  va.setZero();
  aa.setZero();
}

}  // namespace wiimote_tracker::motion
