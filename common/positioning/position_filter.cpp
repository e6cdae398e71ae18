#include "common/positioning/position_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/geometry/rotation.h"

namespace chorus::positioning {
namespace {

// Where everything is in the state.
constexpr int kPlace = 0;
constexpr int kSpeed = 3;  // x and z
constexpr int kHeading = 5;
constexpr int kHeight = 6;
constexpr int kCommonStates = 7;
constexpr int kOfCamera = 4;  // depth, then along, level and steep errors

constexpr double kNearestSeen = 0.1;  // From a camera [m].
// Unknown: a place or a heading that nothing has told yet.
constexpr double kAnywhere = 10.0;     // [m]
constexpr double kFlightHeight = 0.5;  // While nobody stands, the height is not told [m].
// How much more than expected steps may err, as during a slide, and how quickly that is noticed.
constexpr double kMostRestless = 8.0;
constexpr double kNoticing = 0.15;

int camera_at(std::size_t camera) { return kCommonStates + kOfCamera * static_cast<int>(camera); }

/// Axes of a camera's errors: along the line of sight, level across it, and steep across it.
Eigen::Matrix3d sight_axes(const Eigen::Vector3d& line) {
  Eigen::Matrix3d axes;
  axes.col(0) = line.stableNormalized();
  Eigen::Vector3d level = Eigen::Vector3d::UnitY().cross(axes.col(0));
  if (level.norm() < 1e-3) level = Eigen::Vector3d::UnitX();
  axes.col(1) = level.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

double decay(double dt, double memory) { return std::exp(-dt / memory); }

/// Variance that an error gains while it is forgotten, so that it stays at sigma.
double gained(double dt, double memory, double sigma) {
  const double kept = decay(dt, memory);
  return sigma * sigma * (1.0 - kept * kept);
}

}  // namespace

PositionFilter::PositionFilter(std::size_t cameras, const PositionErrors& errors)
    : errors_(errors), cameras_(cameras) {
  const int size = kCommonStates + kOfCamera * static_cast<int>(cameras);
  state_ = Eigen::VectorXd::Zero(size);
  covariance_ = Eigen::MatrixXd::Zero(size, size);
}

void PositionFilter::begin(const Seen& seen, double heading, double heading_sigma) {
  state_.setZero();
  covariance_.setZero();
  state_.segment<3>(kPlace) = seen.place;
  state_[kHeading] = heading;
  covariance_.diagonal().segment<3>(kPlace).setConstant(kAnywhere * kAnywhere);
  covariance_.diagonal().segment<2>(kSpeed).setConstant(errors_.speed * errors_.speed);
  covariance_(kHeading, kHeading) = heading_sigma * heading_sigma;
  covariance_(kHeight, kHeight) = errors_.height * errors_.height;
  distance_ = (seen.place - seen.eye).norm();
  for (std::size_t i = 0; i < cameras_; ++i) {
    const int at = camera_at(i);
    covariance_(at, at) = errors_.depth * errors_.depth;
    covariance_(at + 1, at + 1) = std::pow(errors_.along * distance_, 2);
    covariance_(at + 2, at + 2) = std::pow(errors_.across * distance_, 2);
    covariance_(at + 3, at + 3) = std::pow(errors_.across * distance_, 2);
  }
  restless_ = 1.0;
  begun_ = true;
}

void PositionFilter::predict(const Motion& motion) {
  const auto size = state_.size();
  const double dt = motion.dt;
  step_.transition = Eigen::MatrixXd::Identity(size, size);
  Eigen::MatrixXd& f = step_.transition;
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(size);
  const Eigen::Vector3d moved = about_y(state_[kHeading]) * motion.moved;
  const double kept = decay(dt, errors_.speed_memory);
  f(kPlace, kSpeed) = f(kPlace + 2, kSpeed + 1) = dt;
  f(kSpeed, kSpeed) = f(kSpeed + 1, kSpeed + 1) = kept;
  f(kPlace, kHeading) = moved.z();
  f(kPlace + 2, kHeading) = -moved.x();
  f(kHeight, kHeight) = decay(dt, errors_.height_memory);
  const double speed = (motion.flies ? errors_.flight_speed : errors_.speed) * restless_;
  gain[kPlace] = gain[kPlace + 2] = std::pow(errors_.step * restless_, 2) * dt;
  gain[kPlace + 1] = kFlightHeight * kFlightHeight * dt;
  gain[kSpeed] = gain[kSpeed + 1] = gained(dt, errors_.speed_memory, speed);
  gain[kHeading] = errors_.heading_drift * errors_.heading_drift * dt;
  gain[kHeight] = gained(dt, errors_.height_memory, errors_.height);
  for (std::size_t i = 0; i < cameras_; ++i) {
    const int at = camera_at(i);
    for (int axis = 1; axis < kOfCamera; ++axis) {
      f(at + axis, at + axis) = decay(dt, errors_.memory);
      const double sigma = (axis == 1 ? errors_.along : errors_.across) * distance_;
      gain[at + axis] = gained(dt, errors_.memory, sigma);
    }
  }
  const Eigen::Vector2d drift = state_.segment<2>(kSpeed) * dt;
  Eigen::VectorXd next = f * state_;
  next.segment<3>(kPlace) =
      state_.segment<3>(kPlace) + moved + Eigen::Vector3d(drift.x(), 0.0, drift.y());
  next[kHeading] = state_[kHeading];
  state_ = std::move(next);
  covariance_ = (f * covariance_ * f.transpose()).eval();
  covariance_.diagonal() += gain;
  step_.predicted = state_;
  step_.predicted_covariance = covariance_;
  stand(motion);
}

/// A standing person's hips are as high as the legs say.
void PositionFilter::stand(const Motion& motion) {
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(1, state_.size());
  slope(0, kPlace + 1) = 1.0;
  slope(0, kHeight) = -1.0;
  const Eigen::VectorXd residual =
      Eigen::VectorXd::Constant(1, motion.height - (state_[kPlace + 1] - state_[kHeight]));
  const double sigma = motion.flies ? 0.15 : 0.01;
  update(slope, residual, Eigen::MatrixXd::Constant(1, 1, sigma * sigma));
}

/// As logarithm of the distance and two directions across the line of sight: there the error of all
/// depths adds up with the distance instead of multiplying it.  The axes are those half-way between
/// the expected and the seen direction, which is right to second order.  Axes of the expected
/// direction err alike with the height, and a camera little above the hips then takes a person to
/// be farther and farther away (axes of the seen one: nearer and nearer).
PositionFilter::Measurement PositionFilter::measured(const Seen& seen) const {
  const int at = camera_at(seen.camera);
  const int rows = seen.heading ? 4 : 3;
  const Eigen::Vector3d line = state_.segment<3>(kPlace) - seen.eye;
  const double distance = std::max(kNearestSeen, line.norm());
  const Eigen::Vector3d sight = seen.place - seen.eye;
  const double range = std::max(kNearestSeen, sight.norm());
  const Eigen::Matrix3d axes = sight_axes(line / distance + sight / range);
  Measurement out{Eigen::MatrixXd::Zero(rows, state_.size()), Eigen::VectorXd::Zero(rows),
                  Eigen::MatrixXd::Zero(rows, rows)};
  const double depth = std::max(0.5, 1.0 + state_[at]);
  const Eigen::Vector3d ways = axes.transpose() * (sight / range - line / distance);
  const Eigen::Vector3d errors = state_.segment<3>(at + 1) / distance;
  out.slope.block<3, 3>(0, kPlace) = axes.transpose() / distance;
  out.slope(0, at) = 1.0 / depth;
  out.slope.block<3, 3>(0, at + 1) = Eigen::Matrix3d::Identity() / distance;
  out.residual[0] = std::log(range) - std::log(distance * depth) - errors[0];
  out.residual[1] = ways[1] - errors[1];
  out.residual[2] = ways[2] - errors[2];
  for (int axis = 0; axis < 3; ++axis) {
    // What the geometry says beyond the usual: few rays, or rays that are nearly parallel.
    const Eigen::Vector3d a = axes.col(axis);
    const double usual = (axis == 0 ? errors_.along : errors_.across) * distance;
    const double excess = std::max(0.0, a.dot(seen.covariance * a) - usual * usual);
    out.noise(axis, axis) = (errors_.picture * errors_.picture + excess) / (distance * distance);
  }
  if (seen.heading) {
    out.slope(3, kHeading) = 1.0;
    out.residual[3] = wrap_angle(*seen.heading - state_[kHeading]);
    out.noise(3, 3) = errors_.heading_noise * errors_.heading_noise;
  }
  return out;
}

double PositionFilter::surprise(const Seen& seen) const {
  Seen place = seen;
  place.heading.reset();
  const Measurement m = measured(place);
  const Eigen::MatrixXd s = m.slope * covariance_ * m.slope.transpose() + m.noise;
  return m.residual.dot(s.ldlt().solve(m.residual)) / 3.0;
}

void PositionFilter::see(const Seen& seen) {
  const double wondering = surprise(seen);
  const double wanted = std::clamp(std::sqrt(std::max(0.0, wondering)), 1.0, kMostRestless);
  restless_ += kNoticing * (wanted - restless_);
  const Measurement m = measured(seen);
  update(m.slope, m.residual, m.noise);
  distance_ = (state_.segment<3>(kPlace) - seen.eye).norm();
}

void PositionFilter::update(const Eigen::MatrixXd& slope, const Eigen::VectorXd& residual,
                            const Eigen::MatrixXd& noise) {
  const Eigen::MatrixXd cross = covariance_ * slope.transpose();
  const Eigen::MatrixXd s = slope * cross + noise;
  const Eigen::MatrixXd gain = s.ldlt().solve(cross.transpose()).transpose();
  if (!gain.allFinite()) return;
  state_ += gain * residual;
  covariance_ -= gain * cross.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  state_[kHeading] = wrap_angle(state_[kHeading]);
}

Position position_in(const Eigen::VectorXd& state, const Eigen::MatrixXd& covariance) {
  Position out;
  out.place = state.segment<3>(kPlace);
  out.covariance = covariance.block<3, 3>(kPlace, kPlace);
  out.heading = state[kHeading];
  out.heading_sigma = std::sqrt(std::max(0.0, covariance(kHeading, kHeading)));
  return out;
}

Position PositionFilter::position() const { return position_in(state_, covariance_); }

std::pair<double, double> PositionFilter::depth_of(std::size_t camera) const {
  const int at = camera_at(camera);
  return {state_[at], std::sqrt(std::max(0.0, covariance_(at, at)))};
}

FilterStep PositionFilter::step() const {
  FilterStep out = step_;
  out.filtered = state_;
  out.filtered_covariance = covariance_;
  return out;
}

void PositionFilter::forget_place() {
  covariance_.middleRows<5>(kPlace).setZero();
  covariance_.middleCols<5>(kPlace).setZero();
  covariance_.diagonal().segment<3>(kPlace).setConstant(kAnywhere * kAnywhere);
  covariance_.diagonal().segment<2>(kSpeed).setConstant(errors_.speed * errors_.speed);
}

std::vector<Position> smoothed(const std::vector<FilterStep>& steps) {
  std::vector<Position> out(steps.size());
  if (steps.empty()) return out;
  Eigen::VectorXd state = steps.back().filtered;
  Eigen::MatrixXd covariance = steps.back().filtered_covariance;
  out.back() = position_in(state, covariance);
  for (std::size_t i = steps.size() - 1; i-- > 0;) {
    const FilterStep& now = steps[i];
    const FilterStep& next = steps[i + 1];
    if (next.predicted.size() == 0) {  // It began anew there.
      state = now.filtered;
      covariance = now.filtered_covariance;
      out[i] = position_in(state, covariance);
      continue;
    }
    const Eigen::MatrixXd gain = next.predicted_covariance.ldlt()
                                     .solve(next.transition * now.filtered_covariance)
                                     .transpose();
    Eigen::VectorXd difference = state - next.predicted;
    difference[kHeading] = wrap_angle(difference[kHeading]);
    state = now.filtered + gain * difference;
    covariance = now.filtered_covariance +
                 gain * (covariance - next.predicted_covariance) * gain.transpose();
    out[i] = position_in(state, covariance);
  }
  return out;
}

}  // namespace chorus::positioning
