#include "wiimote_tracker_triangulation/motion/kinematic_states.h"

namespace wiimote_tracker::motion {
namespace {

/// Place of (i, j) in a symmetric block.
constexpr int kSymmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

using Symmetric = std::array<Lanes, 6>;
using Square = std::array<Lanes, 9>;
using Vector = std::array<Lanes, 3>;

/// (sign) x y^T added to a block.
void addOuter(double sign, const Vector& x, Symmetric* block) {
  for (int i = 0; i < 3; ++i) {
    const Lanes signed_x = sign * x[i];
    for (int j = i; j < 3; ++j)
      (*block)[kSymmetric[i][j]] += signed_x * x[j];
  }
}

void addOuter(double sign, const Vector& x, const Vector& y, Square* block) {
  for (int i = 0; i < 3; ++i) {
    const Lanes signed_x = sign * x[i];
    for (int j = 0; j < 3; ++j)
      (*block)[3 * i + j] += signed_x * y[j];
  }
}

template <typename Block>
void mixEach(const std::array<Lanes, 4>& shares, Block* block) {
  for (Lanes& lanes : *block) {
    const double old[] = {lanes[0], lanes[1], lanes[2], lanes[3]};
    lanes = shares[0] * old[0] + shares[1] * old[1] + shares[2] * old[2] + shares[3] * old[3];
  }
}

}  // namespace

void KinematicStates::setZero() {
  for (Vector* block : {&p, &v, &a})
    block->fill(Lanes::Zero());
  for (Symmetric* block : {&pp, &vv, &aa})
    block->fill(Lanes::Zero());
  for (Square* block : {&pv, &pa, &va})
    block->fill(Lanes::Zero());
}

void KinematicStates::predict(const KinematicSteps& s) {
  for (int i = 0; i < 3; ++i) {
    p[i] += s.p_v * v[i] + s.p_a * a[i];
    v[i] += s.v_a * a[i];
    a[i] *= s.a_a;
  }
  // F P F^T: F times P from the left, then the columns. What is read is not yet overwritten: each
  // block only needs those that come after it.
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const int ij = 3 * i + j;
      const int ji = 3 * j + i;
      const int k = kSymmetric[i][j];
      const Lanes right_v = pv[ij] + s.p_v * vv[k] + s.p_a * va[ji];  // of the row p, column v
      const Lanes right_a = pa[ij] + s.p_v * va[ij] + s.p_a * aa[k];
      pp[k] += s.p_v * (pv[ji] + right_v) + s.p_a * (pa[ji] + right_a);
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int ij = 3 * i + j;
      const int ji = 3 * j + i;
      const int k = kSymmetric[i][j];
      const Lanes right_a = pa[ij] + s.p_v * va[ij] + s.p_a * aa[k];
      pv[ij] += s.p_v * vv[k] + s.p_a * va[ji] + s.v_a * right_a;
      pa[ij] = s.a_a * right_a;
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const int k = kSymmetric[i][j];
      vv[k] += s.v_a * (va[3 * i + j] + va[3 * j + i] + s.v_a * aa[k]);
    }
  }
  const Lanes a_a2 = s.a_a * s.a_a;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      va[3 * i + j] = s.a_a * (va[3 * i + j] + s.v_a * aa[kSymmetric[i][j]]);
  }
  for (Lanes& lanes : aa)
    lanes *= a_a2;

  for (int i = 0; i < 3; ++i) {
    const int ii = kSymmetric[i][i];
    pp[ii] += s.noise_pp;
    pv[4 * i] += s.noise_pv;
    pa[4 * i] += s.noise_pa;
    vv[ii] += s.noise_vv;
    va[4 * i] += s.noise_va;
    aa[ii] += s.noise_aa;
  }
}

void KinematicStates::update(const Innovations& n) {
  // With S = L L^T and W = P H^T L^-T: the gain times the innovation is W times the whitened one,
  // and the covariance becomes P - W W^T.
  Vector image_u, image_v;  // H^T L^-T
  for (int i = 0; i < 3; ++i) {
    image_u[i] = n.jacobian(0, i) * n.whiten_uu;
    image_v[i] = n.jacobian(0, i) * n.whiten_vu + n.jacobian(1, i) * n.whiten_vv;
  }
  Vector p_u, p_v, v_u, v_v, a_u, a_v;  // W by rows and columns
  for (int i = 0; i < 3; ++i) {
    const int* s = kSymmetric[i];
    p_u[i] = pp[s[0]] * image_u[0] + pp[s[1]] * image_u[1] + pp[s[2]] * image_u[2];
    p_v[i] = pp[s[0]] * image_v[0] + pp[s[1]] * image_v[1] + pp[s[2]] * image_v[2];
    v_u[i] = pv[i] * image_u[0] + pv[3 + i] * image_u[1] + pv[6 + i] * image_u[2];
    v_v[i] = pv[i] * image_v[0] + pv[3 + i] * image_v[1] + pv[6 + i] * image_v[2];
    a_u[i] = pa[i] * image_u[0] + pa[3 + i] * image_u[1] + pa[6 + i] * image_u[2];
    a_v[i] = pa[i] * image_v[0] + pa[3 + i] * image_v[1] + pa[6 + i] * image_v[2];
    p[i] += p_u[i] * n.u + p_v[i] * n.v;
    v[i] += v_u[i] * n.u + v_v[i] * n.v;
    a[i] += a_u[i] * n.u + a_v[i] * n.v;
  }
  addOuter(-1.0, p_u, &pp);
  addOuter(-1.0, p_v, &pp);
  addOuter(-1.0, p_u, v_u, &pv);
  addOuter(-1.0, p_v, v_v, &pv);
  addOuter(-1.0, p_u, a_u, &pa);
  addOuter(-1.0, p_v, a_v, &pa);
  addOuter(-1.0, v_u, &vv);
  addOuter(-1.0, v_v, &vv);
  addOuter(-1.0, v_u, a_u, &va);
  addOuter(-1.0, v_v, a_v, &va);
  addOuter(-1.0, a_u, &aa);
  addOuter(-1.0, a_v, &aa);
}

void KinematicStates::mix(const std::array<Lanes, 4>& shares,
                          const Lanes& rest_shares,
                          const Eigen::Vector3d& rest_position,
                          const Eigen::Matrix3d& rest_covariance) {
  // By second moments about the place of rest, where they stay small and rest has none but its
  // covariance.
  for (int i = 0; i < 3; ++i)
    p[i] -= rest_position[i];
  addOuter(1.0, p, &pp);
  addOuter(1.0, p, v, &pv);
  addOuter(1.0, p, a, &pa);
  addOuter(1.0, v, &vv);
  addOuter(1.0, v, a, &va);
  addOuter(1.0, a, &aa);
  for (Vector* block : {&p, &v, &a})
    mixEach(shares, block);
  for (Symmetric* block : {&pp, &vv, &aa})
    mixEach(shares, block);
  for (Square* block : {&pv, &pa, &va})
    mixEach(shares, block);
  addOuter(-1.0, p, &pp);
  addOuter(-1.0, p, v, &pv);
  addOuter(-1.0, p, a, &pa);
  addOuter(-1.0, v, &vv);
  addOuter(-1.0, v, a, &va);
  addOuter(-1.0, a, &aa);
  for (int i = 0; i < 3; ++i) {
    p[i] += rest_position[i];
    for (int j = i; j < 3; ++j)
      pp[kSymmetric[i][j]] += rest_shares * rest_covariance(i, j);
  }
}

}  // namespace wiimote_tracker::motion
