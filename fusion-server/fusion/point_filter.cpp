#include "fusion-server/fusion/point_filter.h"

#include <algorithm>

namespace chorus::fusion {
namespace {

/// Covariance P of position and velocity after dt seconds of process noise.
Eigen::Matrix2d spread_after(const Eigen::Matrix2d& covariance, double dt, double density) {
  Eigen::Matrix2d step;
  step << 1, dt, 0, 1;
  Eigen::Matrix2d noise;
  noise << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
  return step * covariance * step.transpose() + density * noise;
}

}  // namespace

void PointFilter::predict(double dt) {
  position_ += dt * velocity_;
  covariance_ = spread_after(covariance_, dt, density_);
}

void PointFilter::update(Timestamp instant, const Eigen::Vector3d& position, double variance) {
  if (!updated_ || instant - *updated_ > kForgotten) {
    position_ = position;
    velocity_.setZero();
    covariance_ << variance, 0, 0, kFirstSpeed * kFirstSpeed;
    updated_ = instant;
    return;
  }
  if (instant > *updated_) {
    predict(seconds(instant - *updated_));
    updated_ = instant;
  }
  const Eigen::Vector2d gain = covariance_.col(0) / (covariance_(0, 0) + variance);
  const Eigen::Vector3d off = position - position_;
  position_ += gain.x() * off;
  velocity_ += gain.y() * off;
  covariance_ = (covariance_ - gain * covariance_.row(0)).eval();
}

std::optional<Eigen::Vector3d> PointFilter::at(Timestamp instant) const {
  if (!updated_) return std::nullopt;
  return Eigen::Vector3d(position_ + std::max(0.0, seconds(instant - *updated_)) * velocity_);
}

double PointFilter::variance_at(Timestamp instant) const {
  if (!updated_) return 0.0;
  const double dt = std::max(0.0, seconds(instant - *updated_));
  return spread_after(covariance_, dt, density_)(0, 0);
}

}  // namespace chorus::fusion
