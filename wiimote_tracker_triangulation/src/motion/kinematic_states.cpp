#include "wiimote_tracker_triangulation/motion/kinematic_states.h"

#include <array>

// What is written once here is compiled for vectors of two numbers, which every processor has, and
// again for vectors of four, which most have. The results are the same to the last bit: the same
// operations, only more of them at once.
#define WIIMOTE_TRACKER_PART_OF_ITS_CALLER inline __attribute__((always_inline))
#if defined(__x86_64__)
#define WIIMOTE_TRACKER_HAS_WIDE_VECTORS __builtin_cpu_supports("avx2")
#define WIIMOTE_TRACKER_WITH_WIDE_VECTORS __attribute__((target("avx2")))
#else
#define WIIMOTE_TRACKER_HAS_WIDE_VECTORS false
#define WIIMOTE_TRACKER_WITH_WIDE_VECTORS
#endif

namespace wiimote_tracker::motion {
namespace {

/// Lanes as a vector of the compiler's own, which it keeps in one register where it can.
using WideLanes = double __attribute__((vector_size(32), aligned(alignof(Lanes)), may_alias));

/// A number per lane, seen as V: Lanes or WideLanes.
template <typename V>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER V& as(Lanes& lanes) {
  return *reinterpret_cast<V*>(&lanes);
}

template <typename V>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER const V& as(const Lanes& lanes) {
  return *reinterpret_cast<const V*>(&lanes);
}

/// Place of (i, j) in a symmetric block.
constexpr int kSymmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

using Symmetric = std::array<Lanes, 6>;
using Square = std::array<Lanes, 9>;
using Vector = std::array<Lanes, 3>;

/// Columns of nine rows: p, v and a.
template <typename V, int kColumns>
struct Columns {
  V p[kColumns][3], v[kColumns][3], a[kColumns][3];
};

/// (sign) x y^T added to a block.
template <int kSign, typename V, int kColumns>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER void addOuter(const V (&x)[kColumns][3], Symmetric* block) {
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      V& to = as<V>((*block)[kSymmetric[i][j]]);
      V sum = to;
      for (int column = 0; column < kColumns; ++column)
        sum += double{kSign} * x[column][i] * x[column][j];
      to = sum;
    }
  }
}

template <int kSign, typename V, int kColumns>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER void addOuter(const V (&x)[kColumns][3],
                                                 const V (&y)[kColumns][3],
                                                 Square* block) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      V& to = as<V>((*block)[3 * i + j]);
      V sum = to;
      for (int column = 0; column < kColumns; ++column)
        sum += double{kSign} * x[column][i] * y[column][j];
      to = sum;
    }
  }
}

/// The same with the whole covariance.
template <int kSign, typename V, int kColumns>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER void addOuter(const Columns<V, kColumns>& x,
                                                 KinematicStates* t) {
  addOuter<kSign>(x.p, &t->pp);
  addOuter<kSign>(x.p, x.v, &t->pv);
  addOuter<kSign>(x.p, x.a, &t->pa);
  addOuter<kSign>(x.v, &t->vv);
  addOuter<kSign>(x.v, x.a, &t->va);
  addOuter<kSign>(x.a, &t->aa);
}

template <typename V>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER Columns<V, 1> means(const KinematicStates& t) {
  Columns<V, 1> result;
  for (int i = 0; i < 3; ++i) {
    result.p[0][i] = as<V>(t.p[i]);
    result.v[0][i] = as<V>(t.v[i]);
    result.a[0][i] = as<V>(t.a[i]);
  }
  return result;
}

template <typename V>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER void predictAs(const KinematicSteps& s,
                                                  KinematicStates* states) {
  KinematicStates& t = *states;
  const V p_a = as<V>(s.p_a), v_a = as<V>(s.v_a), a_a = as<V>(s.a_a);
  for (int i = 0; i < 3; ++i) {
    as<V>(t.p[i]) += s.p_v * as<V>(t.v[i]) + p_a * as<V>(t.a[i]);
    as<V>(t.v[i]) += v_a * as<V>(t.a[i]);
    as<V>(t.a[i]) *= a_a;
  }
  // F P F^T: F times P from the left, then the columns. What is read is not yet overwritten: each
  // block only needs those that come after it.
  V right_a[9];  // of the row p, column a
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int ij = 3 * i + j;
      right_a[ij] = as<V>(t.pa[ij]) + s.p_v * as<V>(t.va[ij]) + p_a * as<V>(t.aa[kSymmetric[i][j]]);
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const int ij = 3 * i + j;
      const int ji = 3 * j + i;
      const int k = kSymmetric[i][j];
      const V right_v = as<V>(t.pv[ij]) + s.p_v * as<V>(t.vv[k]) + p_a * as<V>(t.va[ji]);
      as<V>(t.pp[k]) += s.p_v * (as<V>(t.pv[ji]) + right_v) + p_a * (as<V>(t.pa[ji]) + right_a[ij]);
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int ij = 3 * i + j;
      as<V>(t.pv[ij]) +=
          s.p_v * as<V>(t.vv[kSymmetric[i][j]]) + p_a * as<V>(t.va[3 * j + i]) + v_a * right_a[ij];
      as<V>(t.pa[ij]) = a_a * right_a[ij];
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const int k = kSymmetric[i][j];
      as<V>(t.vv[k]) +=
          v_a * (as<V>(t.va[3 * i + j]) + as<V>(t.va[3 * j + i]) + v_a * as<V>(t.aa[k]));
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      V& va = as<V>(t.va[3 * i + j]);
      va = a_a * (va + v_a * as<V>(t.aa[kSymmetric[i][j]]));
    }
  }
  const V a_a2 = a_a * a_a;
  for (Lanes& lanes : t.aa)
    as<V>(lanes) *= a_a2;

  for (int i = 0; i < 3; ++i) {
    const int ii = kSymmetric[i][i];
    as<V>(t.pp[ii]) += as<V>(s.noise_pp);
    as<V>(t.pv[4 * i]) += as<V>(s.noise_pv);
    as<V>(t.pa[4 * i]) += as<V>(s.noise_pa);
    as<V>(t.vv[ii]) += as<V>(s.noise_vv);
    as<V>(t.va[4 * i]) += as<V>(s.noise_va);
    as<V>(t.aa[ii]) += as<V>(s.noise_aa);
  }
}

template <typename V>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER void updateAs(const Innovations<Lanes>& n,
                                                 KinematicStates* states) {
  KinematicStates& t = *states;
  // With S = L L^T and W = P H^T L^-T: the gain times the innovation is W times the whitened one,
  // and the covariance becomes P - W W^T.
  V image[2][3];  // columns of H^T L^-T
  for (int i = 0; i < 3; ++i) {
    image[0][i] = n.jacobian(0, i) * as<V>(n.whiten_uu);
    image[1][i] = n.jacobian(0, i) * as<V>(n.whiten_vu) + n.jacobian(1, i) * as<V>(n.whiten_vv);
  }
  Columns<V, 2> w;
  for (int column = 0; column < 2; ++column) {
    const V* h = image[column];
    for (int i = 0; i < 3; ++i) {
      const int* s = kSymmetric[i];
      w.p[column][i] =
          as<V>(t.pp[s[0]]) * h[0] + as<V>(t.pp[s[1]]) * h[1] + as<V>(t.pp[s[2]]) * h[2];
      w.v[column][i] =
          as<V>(t.pv[i]) * h[0] + as<V>(t.pv[3 + i]) * h[1] + as<V>(t.pv[6 + i]) * h[2];
      w.a[column][i] =
          as<V>(t.pa[i]) * h[0] + as<V>(t.pa[3 + i]) * h[1] + as<V>(t.pa[6 + i]) * h[2];
    }
  }
  const V u = as<V>(n.u), v = as<V>(n.v);
  for (int i = 0; i < 3; ++i) {
    as<V>(t.p[i]) += w.p[0][i] * u + w.p[1][i] * v;
    as<V>(t.v[i]) += w.v[0][i] * u + w.v[1][i] * v;
    as<V>(t.a[i]) += w.a[0][i] * u + w.a[1][i] * v;
  }
  addOuter<-1>(w, states);
}

template <typename V>
WIIMOTE_TRACKER_PART_OF_ITS_CALLER void mixAs(const std::array<Lanes, 4>& shares,
                                              KinematicStates* states) {
  KinematicStates& t = *states;
  addOuter<1>(means<V>(t), states);
  const V share[] = {as<V>(shares[0]), as<V>(shares[1]), as<V>(shares[2]), as<V>(shares[3])};
  const auto mixEach = [&](auto* block) __attribute__((always_inline)) {
    for (Lanes& lanes : *block) {
      const double* old = lanes.data();
      const V mixed = share[0] * old[0] + share[1] * old[1] + share[2] * old[2] + share[3] * old[3];
      as<V>(lanes) = mixed;
    }
  };
  for (Vector* block : {&t.p, &t.v, &t.a})
    mixEach(block);
  for (Symmetric* block : {&t.pp, &t.vv, &t.aa})
    mixEach(block);
  for (Square* block : {&t.pv, &t.pa, &t.va})
    mixEach(block);
  addOuter<-1>(means<V>(t), states);
}

WIIMOTE_TRACKER_WITH_WIDE_VECTORS void predictWide(const KinematicSteps& s, KinematicStates* t) {
  predictAs<WideLanes>(s, t);
}

WIIMOTE_TRACKER_WITH_WIDE_VECTORS void updateWide(const Innovations<Lanes>& n, KinematicStates* t) {
  updateAs<WideLanes>(n, t);
}

WIIMOTE_TRACKER_WITH_WIDE_VECTORS void mixWide(const std::array<Lanes, 4>& shares,
                                               KinematicStates* t) {
  mixAs<WideLanes>(shares, t);
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

void KinematicStates::predict(const KinematicSteps& steps) {
  if (WIIMOTE_TRACKER_HAS_WIDE_VECTORS)
    predictWide(steps, this);
  else
    predictAs<Lanes>(steps, this);
}

void KinematicStates::update(const Innovations<Lanes>& innovations) {
  if (WIIMOTE_TRACKER_HAS_WIDE_VECTORS)
    updateWide(innovations, this);
  else
    updateAs<Lanes>(innovations, this);
}

void KinematicStates::forget(const Eigen::Vector3d& direction,
                             double kept,
                             double speed_variance,
                             const Lanes& acceleration_variances) {
  // x' = M x with M = I - lost r r^T.
  const Eigen::Vector3d& r = direction;
  const double lost = 1.0 - kept;
  for (Vector* x : {&v, &a}) {
    const Lanes along = r[0] * (*x)[0] + r[1] * (*x)[1] + r[2] * (*x)[2];
    for (int i = 0; i < 3; ++i)
      (*x)[i] -= lost * r[i] * along;
  }
  for (Square* block : {&pv, &pa, &va}) {  // from the right
    for (int i = 0; i < 3; ++i) {
      Lanes* row = block->data() + 3 * i;
      const Lanes along = r[0] * row[0] + r[1] * row[1] + r[2] * row[2];
      for (int j = 0; j < 3; ++j)
        row[j] -= lost * r[j] * along;
    }
  }
  for (int j = 0; j < 3; ++j) {  // from the left
    const Lanes along = r[0] * va[j] + r[1] * va[3 + j] + r[2] * va[6 + j];
    for (int i = 0; i < 3; ++i)
      va[3 * i + j] -= lost * r[i] * along;
  }
  const auto fromBothSides = [&](Symmetric* block, const Lanes& variance) {
    Vector along;
    for (int i = 0; i < 3; ++i) {
      const int* s = kSymmetric[i];
      along[i] = r[0] * (*block)[s[0]] + r[1] * (*block)[s[1]] + r[2] * (*block)[s[2]];
    }
    const Lanes twice = r[0] * along[0] + r[1] * along[1] + r[2] * along[2];
    const Lanes both = lost * lost * twice + (1.0 - kept * kept) * variance;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j)
        (*block)[kSymmetric[i][j]] +=
            both * (r[i] * r[j]) - lost * (along[i] * r[j] + along[j] * r[i]);
    }
  };
  fromBothSides(&vv, Lanes::Constant(speed_variance));
  fromBothSides(&aa, acceleration_variances);
}

void KinematicStates::mix(const std::array<Lanes, 4>& shares,
                          const Lanes& rest_shares,
                          const Eigen::Vector3d& rest_position,
                          const Eigen::Matrix3d& rest_covariance) {
  // By second moments about the place of rest, where they stay small and rest has none but its
  // covariance.
  for (int i = 0; i < 3; ++i)
    p[i] -= rest_position[i];
  if (WIIMOTE_TRACKER_HAS_WIDE_VECTORS)
    mixWide(shares, this);
  else
    mixAs<Lanes>(shares, this);
  for (int i = 0; i < 3; ++i) {
    p[i] += rest_position[i];
    for (int j = i; j < 3; ++j)
      pp[kSymmetric[i][j]] += rest_shares * rest_covariance(i, j);
  }
}

}  // namespace wiimote_tracker::motion
