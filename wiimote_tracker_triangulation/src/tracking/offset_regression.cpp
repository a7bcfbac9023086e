#include "offset_regression.h"

#include <Eigen/LU>

#include <algorithm>

namespace wiimote_tracker::tracking {
namespace {

using Complex = OffsetRegression::Complex;

Eigen::Vector2cd products(const Complex& pixel, const Complex& other) {
  return {std::conj(pixel) * other, pixel * other};
}

}  // namespace

void OffsetRegression::add(const Eigen::Vector2d& pixel,
                           const Eigen::Vector2d& velocity,
                           const Eigen::Vector2d& residual) {
  const Complex p(pixel.x(), pixel.y());
  const Complex v(velocity.x(), velocity.y());
  const Complex r(residual.x(), residual.y());
  count_ += 1.0;
  pixel_ += p;
  velocity_ += v;
  residual_ += r;
  pixel_pixel_ += products(p, p);
  pixel_velocity_ += products(p, v);
  pixel_residual_ += products(p, r);
  velocity_residual_ += velocity.dot(residual);
  squared_velocity_ += velocity.squaredNorm();
  squared_residual_ += residual.squaredNorm();
}

std::optional<OffsetRegression::Estimate> OffsetRegression::estimate(double turn_stddev) const {
  // The noise is as if so many further spots were off by 1 px per axis.
  constexpr double kAssumed = 10.0;
  // Share of a calibration's error that no linear map takes, since the image of a nearer LED moves
  // farther. It may go with the velocity by chance.
  constexpr double kNotLinear = 0.2;
  if (!(count_ > 0.0))
    return std::nullopt;
  // residual = -offset * velocity + c + a p + b conj(p) + noise, since a time that is too late
  // predicts the LED too far along its motion. c is eliminated by means, then a and b, the general
  // linear map of the plane, whose prior is 0 +- turn_stddev where the noise is 1 px: what is left
  // of residuals and velocities after a regression on p gives the offset (Frisch-Waugh theorem).
  const Products by_pixel = pixel_pixel_ - products(pixel_, pixel_) / count_;
  const Products by_velocity = pixel_velocity_ - products(pixel_, velocity_) / count_;
  const Products by_residual = pixel_residual_ - products(pixel_, residual_) / count_;
  const double squared_turn = turn_stddev * turn_stddev;
  Eigen::Matrix2cd normal;
  normal << by_pixel[0], std::conj(by_pixel[1]), by_pixel[1], by_pixel[0];
  const Eigen::Matrix2cd covariance =  // of a and b
      squared_turn * (Eigen::Matrix2cd::Identity() + squared_turn * normal).inverse();
  const Eigen::Vector2cd of_velocity = covariance * by_velocity;
  const Eigen::Vector2cd of_residual = covariance * by_residual;

  const double velocity_scatter =
      squared_velocity_ - std::norm(velocity_) / count_ - std::real(by_velocity.dot(of_velocity));
  if (!(velocity_scatter > 0.0))
    return std::nullopt;
  const double covariation = velocity_residual_ -
                             std::real(std::conj(velocity_) * residual_) / count_ -
                             std::real(by_velocity.dot(of_residual));
  const double unexplained = squared_residual_ - std::norm(residual_) / count_ -
                             std::real(by_residual.dot(of_residual)) -
                             covariation * covariation / velocity_scatter;
  const double variance =
      (std::max(unexplained, 0.0) + 2.0 * kAssumed) / (2.0 * (count_ + kAssumed));
  const double not_linear = kNotLinear * kNotLinear * squared_turn * std::real(by_pixel[0]);
  return Estimate{-covariation / velocity_scatter, variance / velocity_scatter,
                  not_linear / velocity_scatter};
}

}  // namespace wiimote_tracker::tracking
