#include "motion/textbook_imm.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace wiimote_tracker::motion::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// In the order of TextbookImm::models().
constexpr int kResting = kRestModeNames.size();
constexpr int kMoving = kMovingModeNames.size() + 1;  // and the sudden one
constexpr int kModes = kResting + kMoving;

MatrixXd blocks(double pp, double vv, double aa) {
  VectorXd diagonal(9);
  diagonal << pp, pp, pp, vv, vv, vv, aa, aa, aa;
  return diagonal.asDiagonal();
}

/// Standard deviation of the acceleration of a moving mode; 0 of the others.
double acceleration(const MotionOptions& options, int model) {
  return model < kResting || model == kModes - 1 ? 0.0 : options.moving[model - kResting].stddev;
}

/// Of one axis.
Transition transition(const MotionOptions& options, int model, double duration) {
  const MatrixXd zero = MatrixXd::Zero(3, 3);
  if (model < kResting) {
    const double drift = options.rest[model].drift;
    MatrixXd density = zero;
    density(0, 0) = drift * drift;
    return {zero, density, duration};
  }
  if (model < kModes - 1) {
    const SingerMode& mode = options.moving[model - kResting];
    return singerTransition(mode.stddev, mode.time, duration);
  }
  MatrixXd A = zero, density = zero;
  A(0, 1) = 1.0;
  density(1, 1) = options.sudden_random_walk * options.sudden_random_walk;
  Transition t(A, density, duration);
  t.F(2, 2) = 0.0;
  return t;
}

/// By its series, of a part so small that it converges at once.
MatrixXd exponential(const MatrixXd& m) {
  const int halvings = std::max(0, static_cast<int>(std::ceil(std::log2(m.norm()))) + 3);
  const MatrixXd part = m / std::ldexp(1.0, halvings);
  MatrixXd term = MatrixXd::Identity(m.rows(), m.cols());
  MatrixXd sum = term;
  for (int i = 1; i < 20; ++i) {
    term = term * part / i;
    sum += term;
  }
  for (int i = 0; i < halvings; ++i)
    sum = sum * sum;
  return sum;
}

struct Image {
  Eigen::Vector2d pixel;  // of the mean
  MatrixXd H = MatrixXd::Zero(2, 9);
};

Image imageOf(const geometry::Camera& camera, const Eigen::Vector3d& mean) {
  Image image;
  Eigen::Matrix<double, 2, 3> by_position;
  image.pixel = *camera.project(mean, &by_position);
  image.H.leftCols<3>() = by_position;
  return image;
}

double normalDensity(const Eigen::Vector2d& x, const Eigen::Matrix2d& covariance) {
  return std::exp(-0.5 * x.dot(covariance.inverse() * x)) /
         (2.0 * M_PI * std::sqrt(covariance.determinant()));
}

}  // namespace

Transition::Transition(const MatrixXd& A, const MatrixXd& density, double duration) {
  const Eigen::Index n = A.rows();
  MatrixXd m = MatrixXd::Zero(2 * n, 2 * n);
  m.topLeftCorner(n, n) = -A * duration;
  m.topRightCorner(n, n) = density * duration;
  m.bottomRightCorner(n, n) = A.transpose() * duration;
  const MatrixXd e = exponential(m);
  F = e.bottomRightCorner(n, n).transpose();
  Q = F * e.topRightCorner(n, n);
}

Transition Transition::inThreeAxes() const {
  Transition result = *this;
  result.F = result.Q = MatrixXd::Zero(9, 9);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      result.F.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(F(i, j));
      result.Q.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(Q(i, j));
    }
  }
  return result;
}

Transition singerTransition(double stddev, double time, double duration) {
  MatrixXd A(3, 3), density = MatrixXd::Zero(3, 3);
  A << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0 / time;
  density(2, 2) = 2.0 * stddev * stddev / time;
  return {A, density, duration};
}

TextbookImm::TextbookImm(const MotionOptions& options,
                         double time,
                         const Eigen::Vector3d& position,
                         const Eigen::Matrix3d& covariance)
    : options_(options), time_(time), models_(kModes) {
  for (int i = 0; i < kModes; ++i) {
    // Rest as a whole is as probable as each moving mode.
    models_[i].probability = 1.0 / ((kMoving + 1.0) * (i < kResting ? kResting : 1));
    models_[i].mean = VectorXd::Zero(9);
    models_[i].mean.head<3>() = position;
    const double a = acceleration(options, i);
    models_[i].covariance =
        blocks(0.0, i < kResting ? 0.0 : options.initial_speed * options.initial_speed, a * a);
    models_[i].covariance.topLeftCorner<3, 3>() = covariance;
  }
}

void TextbookImm::predict(double time) {
  for (int i = 0; i < kModes; ++i) {
    const Transition t = transition(options_, i, time - time_).inThreeAxes();
    models_[i].mean = (t.F * models_[i].mean).eval();
    models_[i].covariance = (t.F * models_[i].covariance * t.F.transpose() + t.Q).eval();
  }
  time_ = time;
}

void TextbookImm::stop(double duration) {
  MatrixXd rates = MatrixXd::Zero(kModes, kModes);
  rates.bottomLeftCorner(kMoving, kResting).setConstant(options_.stop_rate / kResting);
  interact(rates, duration);
}

void TextbookImm::change(double duration) {
  MatrixXd rates = MatrixXd::Zero(kModes, kModes);
  for (int i = 0; i < kResting; ++i)
    rates.row(i).tail(kMoving).setConstant(options_.rest[i].start_rate / kMoving);
  for (int i = 0; i < kMoving; ++i) {
    for (int j = 0; j < kMoving; ++j) {
      double& rate = rates(kResting + i, kResting + j);
      if (j > i)
        rate = options_.rise_rate / (kMoving - 1 - i);
      else if (j < i)
        rate = options_.settle_rate / i;
    }
  }
  interact(rates, duration);
}

void TextbookImm::interact(const MatrixXd& rates, double duration) {
  MatrixXd p(kModes, kModes);  // probabilities
  for (int i = 0; i < kModes; ++i) {
    p.row(i) = rates.row(i) * duration / (1.0 + rates.row(i).sum() * duration);
    p(i, i) = 1.0 - p.row(i).sum();
  }

  const std::vector<Model> before = models_;
  for (int j = 0; j < kModes; ++j) {
    // A more agile mode begins with its own acceleration; a mode at rest has none.
    const double a = acceleration(options_, j);
    double& probability = models_[j].probability;
    probability = 0.0;
    for (int i = 0; i < kModes; ++i)
      probability += p(i, j) * before[i].probability;
    models_[j].mean.setZero();
    models_[j].covariance.setZero();
    std::vector<Model> entering = before;
    for (int i = 0; i < kModes; ++i) {
      if (j < kResting) {
        entering[i].mean.tail<6>().setZero();
        entering[i].covariance.rightCols<6>().setZero();
        entering[i].covariance.bottomRows<6>().setZero();
      } else if (i < j) {
        entering[i].covariance += blocks(0.0, 0.0, a * a);
      }
      models_[j].mean += p(i, j) * before[i].probability / probability * entering[i].mean;
    }
    for (int i = 0; i < kModes; ++i) {
      const VectorXd d = entering[i].mean - models_[j].mean;
      models_[j].covariance += p(i, j) * before[i].probability / probability *
                               (entering[i].covariance + d * d.transpose());
    }
  }
}

void TextbookImm::update(const geometry::Camera& camera,
                         const Eigen::Vector2d& pixel,
                         double pixel_stddev) {
  const Eigen::Vector3d at = mean().head<3>();
  const Image image = imageOf(camera, at);
  const MatrixXd& H = image.H;
  double sum = 0.0;
  for (Model& m : models_) {
    const Eigen::Matrix2d S = H * m.covariance * H.transpose() +
                              pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity();
    const MatrixXd K = m.covariance * H.transpose() * S.inverse();
    const Eigen::Vector2d innovation =
        pixel - image.pixel - H.leftCols<3>() * (m.mean.head<3>() - at);
    m.mean += K * innovation;
    m.covariance -= (K * S * K.transpose()).eval();
    m.probability *= normalDensity(innovation, S);
    sum += m.probability;
  }
  for (Model& m : models_)
    m.probability /= sum;
}

double TextbookImm::density(const geometry::Camera& camera,
                            const Eigen::Vector2d& pixel,
                            double pixel_stddev) const {
  const Eigen::Vector3d at = mean().head<3>();
  const Image image = imageOf(camera, at);
  double sum = 0.0;
  for (const Model& m : models_) {
    const Eigen::Matrix2d S = image.H * m.covariance * image.H.transpose() +
                              pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity();
    sum += m.probability *
           normalDensity(pixel - image.pixel - image.H.leftCols<3>() * (m.mean.head<3>() - at), S);
  }
  return sum;
}

VectorXd TextbookImm::mean() const {
  VectorXd mean = VectorXd::Zero(9);
  for (const Model& m : models_)
    mean += m.probability * m.mean;
  return mean;
}

MatrixXd TextbookImm::covariance() const {
  const VectorXd center = mean();
  MatrixXd covariance = MatrixXd::Zero(9, 9);
  for (const Model& m : models_) {
    const VectorXd d = m.mean - center;
    covariance += m.probability * (m.covariance + d * d.transpose());
  }
  return covariance;
}

}  // namespace wiimote_tracker::motion::test
