#include "fusion-server/fusion/motion_filter.h"

#include <algorithm>
#include <cmath>

#include "fusion-server/fusion/point_filter.h"

namespace chorus::fusion {
namespace {

constexpr double kRests = 0.5;        // [s] mean time that a point stays at rest, or in motion
constexpr double kSetsOff = 4.0;      // [s] mean time of either, of a point that nobody sees
constexpr double kLeastShare = 1e-3;  // smallest probability of a model: neither is ever excluded
constexpr double kReach = 3.5;        // [standard deviations] farther measurements are clipped
constexpr double kDimensions = 3.0;
constexpr double kSlowing = 0.4;  // [s] time constant of the decay of an unseen point's speed

/// Mean fraction of the next `passed` seconds that a point will have spent in the other model.
double changed_share(double passed) {
  const double turns = 2.0 * passed / kSetsOff;
  return turns > 0 ? 0.5 * (1.0 - (1.0 - std::exp(-turns)) / turns) : 0.0;
}

}  // namespace

PointMotion later(const PointMotion& now, double passed) {
  const double left = std::exp(-passed / kSlowing);
  const double way = kSlowing * (1.0 - left);  // time to go as far at full speed [s]
  const JointMotion& moving = now.motion;
  const double usual = moving.usual_density - moving.density;
  const double density = moving.density + 2.0 * changed_share(passed) * usual;
  const double gone = passed - 2.0 * way + 0.5 * kSlowing * (1.0 - left * left);
  PointMotion then = now;
  then.position += way * moving.velocity;
  then.variance +=
      way * (2.0 * moving.shared + way * moving.variance) + density * kSlowing * kSlowing * gone;
  then.motion.velocity *= left;
  then.motion.shared = left * (moving.shared + way * moving.variance) + 0.5 * density * way * way;
  then.motion.variance =
      left * left * moving.variance + 0.5 * density * kSlowing * (1.0 - left * left);
  then.motion.density += (1.0 - std::exp(-2.0 * passed / kSetsOff)) * usual;
  return then;
}

MotionFilter::MotionFilter(const Densities& densities) {
  models_[0].density = densities.resting;
  models_[1].density = densities.moving;
}

void MotionFilter::begin(Timestamp instant, const Eigen::Vector3d& position, double variance) {
  for (Model& model : models_) {
    model.share = 0.5;
    model.position = position;
    model.velocity.setZero();
    model.covariance << variance, 0, 0, kFirstSpeed * kFirstSpeed;
  }
  updated_ = instant;
}

void MotionFilter::mix(Models& models, double passed) {
  const double change = 0.5 * (1.0 - std::exp(-2.0 * passed / kRests));
  const Models before = models;
  for (std::size_t to = 0; to < 2; ++to) {
    const std::size_t from = 1 - to;
    const double stays = (1.0 - change) * before[to].share;
    const double comes = change * before[from].share;
    const double came = comes / (stays + comes);
    const Eigen::Vector3d apart = before[from].position - before[to].position;
    const Eigen::Vector3d faster = before[from].velocity - before[to].velocity;
    Model& model = models[to];
    model.share = stays + comes;
    model.position += came * apart;
    model.velocity += came * faster;
    Eigen::Matrix2d spread;
    spread << apart.squaredNorm(), apart.dot(faster), apart.dot(faster), faster.squaredNorm();
    model.covariance = (1.0 - came) * before[to].covariance + came * before[from].covariance +
                       came * (1.0 - came) / kDimensions * spread;
  }
}

void MotionFilter::predict(Model& model, double dt) {
  Eigen::Matrix2d step;
  step << 1, dt, 0, 1;
  Eigen::Matrix2d noise;
  noise << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
  model.position += dt * model.velocity;
  model.covariance = step * model.covariance * step.transpose() + model.density * noise;
}

// What is clipped says less: the covariance shrinks only as far as the measurement was taken
// (Joseph's form with the gain that was used).  Somebody who moves faster than expected is clipped
// again and again; the variance, and with it the reach, then grows until they are followed.
double MotionFilter::correct(Model& model, const Eigen::Vector3d& position, double variance,
                             double reach) {
  const double expected = model.covariance(0, 0) + variance;
  const Eigen::Vector3d whole = position - model.position;
  const double taken = whole.norm() > reach ? reach / whole.norm() : 1.0;
  const Eigen::Vector3d off = taken * whole;
  const Eigen::Vector2d gain = taken / expected * model.covariance.col(0);
  model.position += gain.x() * whole;
  model.velocity += gain.y() * whole;
  Eigen::Matrix2d left = Eigen::Matrix2d::Identity();
  left.col(0) -= gain;
  model.covariance =
      (left * model.covariance * left.transpose() + variance * gain * gain.transpose()).eval();
  return -0.5 * (kDimensions * std::log(expected) + off.squaredNorm() / expected);
}

void MotionFilter::update(Timestamp instant, const Eigen::Vector3d& position, double variance) {
  if (!updated_ || instant - *updated_ > kForgotten || instant < *updated_) {
    return begin(instant, position, variance);
  }
  const double passed = seconds(instant - *updated_);
  if (passed > 0) mix(models_, passed);
  for (Model& model : models_) predict(model, passed);
  const double reach = kReach * std::sqrt(models_[1].covariance(0, 0) + variance);
  std::array<double, 2> likely{};
  for (std::size_t i = 0; i < 2; ++i) likely[i] = correct(models_[i], position, variance, reach);
  const double best = std::max(likely[0], likely[1]);
  double sum = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    models_[i].share = std::max(kLeastShare, models_[i].share * std::exp(likely[i] - best));
    sum += models_[i].share;
  }
  for (Model& model : models_) model.share /= sum;
  updated_ = instant;
}

/// Mean and spread of both models.
PointMotion MotionFilter::updated_motion() const {
  PointMotion all;
  for (const Model& model : models_) {
    all.position += model.share * model.position;
    all.motion.velocity += model.share * model.velocity;
    all.motion.density += model.share * model.density;
    all.motion.usual_density += 0.5 * model.density;
  }
  for (const Model& model : models_) {
    const Eigen::Vector3d apart = model.position - all.position;
    const Eigen::Vector3d faster = model.velocity - all.motion.velocity;
    const auto spread = [&](double own, double between) {
      return model.share * (own + between / kDimensions);
    };
    all.variance += spread(model.covariance(0, 0), apart.squaredNorm());
    all.motion.shared += spread(model.covariance(0, 1), apart.dot(faster));
    all.motion.variance += spread(model.covariance(1, 1), faster.squaredNorm());
  }
  return all;
}

std::optional<PointMotion> MotionFilter::at(Timestamp instant) const {
  if (!updated_) return std::nullopt;
  return later(updated_motion(), std::max(0.0, seconds(instant - *updated_)));
}

}  // namespace chorus::fusion
