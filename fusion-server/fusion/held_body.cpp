#include "fusion-server/fusion/held_body.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/base/square.h"
#include "common/geometry/ray.h"

namespace chorus::fusion {
namespace {

using enum JointId;

// Of people who walk about; of sizes judged from rays and from a network's shapes on real cameras
// and in simulation (docs/benchmarks/camera.md, One camera left).
constexpr double kSpeed = 0.7;      // [m/s] per axis
constexpr double kSpeedTime = 1.0;  // [s] over which people keep it
constexpr double kRatio = 0.06;     // of a size that one camera shows
constexpr double kRatioTime = 2.0;  // [s] over which that error stays the same
constexpr double kWhite = 0.03;     // of such a size, independent at every instant
constexpr double kPose = 0.02;      // [m] of the torso's middle, independent
// [m] by which a joint's depth differs from where it is held, or from what a camera guesses.
constexpr double kHeldDepth = 0.08;
constexpr double kGuessedDepth = 0.06;
constexpr double kBone = 0.02;        // [m] of a bone's length in one picture
constexpr double kShortBone = 0.03;   // [m]; shorter ones show no size
constexpr double kLeastLength = 0.5;  // of a bone's length that is left without its noise
constexpr int kScaleRounds = 3;
constexpr double kNearestBody = 0.3;    // [m] from the camera
constexpr double kUnseenTooLong = 3.0;  // [s] after which a joint that nobody saw is not expected
constexpr double kUnlikelyBone = 3.0;   // [standard deviations] beyond it, a bone counts less
constexpr std::size_t kFewest = 3;      // joints that place a body

// Broader than in_trunk(): shoulders and hips turn with the trunk, the head does not.
constexpr std::array kTorso{SpineBase,    SpineMid,      SpineShoulder, Neck,
                            ShoulderLeft, ShoulderRight, HipLeft,       HipRight};

/// Mean of where the joints of one body are from the same joints of another; over the torso if that
/// has enough of them.
struct Shift {
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< Of `from`.
  std::size_t count = 0;
};

Shift shift_of(const PlacedBody& from, const PlacedBody& to) {
  Shift torso;
  Shift all;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!from[j].placed || !to[j].placed) continue;
    const bool in = std::ranges::find(kTorso, static_cast<JointId>(j)) != kTorso.end();
    for (Shift* each : {&torso, &all}) {
      if (each == &torso && !in) continue;
      each->way += to[j].position - from[j].position;
      each->middle += from[j].position;
      ++each->count;
    }
  }
  Shift& best = torso.count >= kFewest ? torso : all;
  if (best.count > 0) {
    best.way /= static_cast<double>(best.count);
    best.middle /= static_cast<double>(best.count);
  }
  return best;
}

/// A bone in a camera's points, and as it was learned.
struct Span {
  double shown = 0.0;  ///< [m]
  double held = 0.0;   ///< [m]
  double variance = 0.0;
};

/// What both ends of a bone err by across the rays makes it longer: this is taken off its length.
/// `sight`: from the camera to the body.
Span span_of(const PlacedJoint& parent, const PlacedJoint& child, const Eigen::Vector3d& sight) {
  const Eigen::Vector3d way = child.position - parent.position;
  const Eigen::Vector3d u = way.normalized();
  const Eigen::Matrix3d both = parent.covariance + child.covariance;
  const double noise = 0.5 * (both.trace() - sight.dot(both * sight));  // of one axis across
  const double longer = noise * (1.0 + square(u.dot(sight)));
  const double square_length = way.squaredNorm();
  return {std::sqrt(std::max(square(kLeastLength) * square_length, square_length - longer)), 0.0,
          u.dot(both * u) + square(kBone)};
}

std::vector<Span> spans_of(const PlacedBody& points, const Eigen::Vector3d& eye,
                           const HeldBones& bones) {
  const Eigen::Vector3d sight = (shift_of(points, points).middle - eye).normalized();
  std::vector<Span> spans;
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const PlacedJoint& parent = points[index_of(kBones[b].parent)];
    const PlacedJoint& child = points[index_of(kBones[b].child)];
    if (!parent.placed || !child.placed || !(bones[b].sigma > 0)) continue;
    if (!((child.position - parent.position).norm() > kShortBone)) continue;
    Span span = span_of(parent, child, sight);
    span.held = bones[b].length;
    span.variance += square(bones[b].sigma);
    spans.push_back(span);
  }
  return spans;
}

}  // namespace

void HeldBody::predict(double passed) {
  // What follows is exact for a step of any length; after a longer one nothing is expected.
  passed_ = std::clamp(passed, 0.0, kUnseenTooLong);
  const double kept = std::exp(-passed_ / kSpeedTime);
  const double way = kSpeedTime * (1.0 - kept);
  const double same = std::exp(-passed_ / kRatioTime);
  Spread step = Spread::Identity();
  step.block<3, 3>(0, 3) = way * Eigen::Matrix3d::Identity();
  step.block<3, 3>(3, 3) = kept * Eigen::Matrix3d::Identity();
  step(6, 6) = same;
  state_ = step * state_;
  spread_ = step * spread_ * step.transpose();
  // Ornstein and Uhlenbeck's process, integrated.
  const double gone = passed_ - 2.0 * way + 0.5 * kSpeedTime * (1.0 - square(kept));
  const double density = 2.0 * square(kSpeed) / kSpeedTime;
  for (int i = 0; i < 3; ++i) {
    spread_(i, i) += density * square(kSpeedTime) * gone;
    spread_(i, i + 3) += 0.5 * density * way * way;
    spread_(i + 3, i) += 0.5 * density * way * way;
    spread_(i + 3, i + 3) += square(kSpeed) * (1.0 - square(kept));
  }
  spread_(6, 6) += square(kRatio) * (1.0 - square(same));
  grow_older(passed);
}

void HeldBody::grow_older(double passed) {
  const double same = std::exp(-passed_ / kRatioTime);
  for (auto& [sensor, ratio] : ratios_) {
    ratio.value *= same;
    ratio.variance = square(same) * ratio.variance + square(kRatio) * (1.0 - square(same));
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    unseen_[j] += passed;
    if (unseen_[j] > kUnseenTooLong) body_[j] = {};
    body_[j].position += state_.head<3>();
  }
  state_.head<3>().setZero();
}

/// Takes that the way is `way`, beside what `slopes` makes of the ratio.
void HeldBody::correct(const Slopes& slopes, const Eigen::Vector3d& way,
                       const Eigen::Matrix3d& noise) {
  const Eigen::Matrix3d expected = slopes * spread_ * slopes.transpose() + noise;
  const Eigen::Matrix<double, 7, 3> gain = spread_ * slopes.transpose() * expected.inverse();
  state_ += gain * (way - slopes * state_);
  spread_ -= gain * slopes * spread_;
  spread_ = 0.5 * (spread_ + spread_.transpose()).eval();
}

void HeldBody::leave() {
  if (left_) ratios_[*left_] = {state_(6), spread_(6, 6)};
  left_.reset();
  state_(6) = 0.0;
  spread_.row(6).setZero();
  spread_.col(6).setZero();
  spread_(6, 6) = kRatio * kRatio;
}

void HeldBody::take(const PlacedBody& seen) {
  leave();
  lengths_.learn(seen, passed_, model_);
  bones_ = lengths_.held(model_);
  const Shift shift = shift_of(body_, seen);
  if (shift.count >= kFewest) {
    Slopes slopes = Slopes::Zero();
    slopes.leftCols<3>().setIdentity();
    correct(slopes, shift.way, square(kPose) * Eigen::Matrix3d::Identity());
  } else {
    state_.setZero();
    spread_.setZero();
    spread_.diagonal() << Eigen::Vector3d::Constant(square(kPose)),
        Eigen::Vector3d::Constant(square(kSpeed)), square(kRatio);
  }
  replace(seen);
}

/// The joints on the camera's rays: at the depths that it guesses, or else where they are held.
PlacedBody HeldBody::on_rays(const RayView& view) const {
  PlacedBody points;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!view.rays[j].placed) continue;
    const Eigen::Vector3d& ray = view.rays[j].position;
    double depth = view.depth[j];
    double own = kGuessedDepth;
    if (!(depth > 0)) {
      if (!body_[j].placed) continue;
      depth = ray.dot(body_[j].position - view.eye);
      own = kHeldDepth;
    }
    if (!(depth > kNearestBody)) continue;
    const Eigen::Matrix3d off = across(ray);
    const double noise = 0.5 * (off * view.rays[j].covariance * off).trace();
    points[j] = {view.eye + depth * ray,
                 depth * depth * noise * off + own * own * ray * ray.transpose(), true};
  }
  return points;
}

/// The points enlarged about the camera so that their bones have the learned lengths.
PlacedBody HeldBody::enlarged(PlacedBody points, const Eigen::Vector3d& eye) const {
  const std::vector<Span> spans = spans_of(points, eye, bones_);
  double scale = 1.0;
  for (int round = 0; round < kScaleRounds; ++round) {
    double sum = 0.0;
    double weights = 0.0;
    for (const Span& span : spans) {
      const double off = std::abs(scale * span.shown - span.held) / std::sqrt(span.variance);
      const double weight = (off > kUnlikelyBone ? kUnlikelyBone / off : 1.0) / span.variance;
      sum += weight * span.shown * span.held;
      weights += weight * span.shown * span.shown;
    }
    if (weights > 0) scale = sum / weights;
  }
  for (PlacedJoint& joint : points) joint.position = eye + scale * (joint.position - eye);
  return points;
}

void HeldBody::compare(const RayView& view, const PlacedBody& seen) {
  const Shift shift = shift_of(seen, enlarged(on_rays(view), view.eye));
  const Eigen::Vector3d sight = shift.middle - view.eye;
  if (shift.count < kFewest || !(sight.norm() > kNearestBody)) return;
  const double found = shift.way.dot(sight) / sight.squaredNorm();
  Ratio& ratio = ratios_.try_emplace(view.sensor, Ratio{0.0, square(kRatio)}).first->second;
  const double gain = ratio.variance / (ratio.variance + square(kWhite));
  ratio.value += gain * (found - ratio.value);
  ratio.variance *= 1.0 - gain;
}

void HeldBody::use(const RayView& view) {
  if (left_ == view.sensor) return;
  leave();
  const auto known = ratios_.find(view.sensor);
  left_ = view.sensor;
  if (known == ratios_.end()) return;
  state_(6) = known->second.value;
  spread_(6, 6) = known->second.variance;
}

std::optional<PlacedBody> HeldBody::follow(const RayView& view) {
  PlacedBody points = on_rays(view);
  if (shift_of(body_, points).count < kFewest) return std::nullopt;
  points = enlarged(points, view.eye);
  const Shift shift = shift_of(body_, points);
  const Eigen::Vector3d sight = shift.middle - view.eye;
  const double distance = sight.norm();
  const Eigen::Vector3d u = sight / distance;
  const double there = distance + u.dot(shift.way);
  if (!(distance > kNearestBody) || !(there > kNearestBody)) return std::nullopt;
  use(view);
  Slopes slopes = Slopes::Zero();
  slopes.leftCols<3>().setIdentity();
  slopes.col(6) = distance * u;
  correct(slopes, shift.way,
          square(kPose) * across(u) + square(kWhite * distance) * u * u.transpose());
  const double now = std::max(kNearestBody, distance + u.dot(state_.head<3>()));
  for (PlacedJoint& joint : points)
    joint.position = view.eye + now / there * (joint.position - view.eye);
  points = hold_bones(points, bones_);
  replace(points);
  const Eigen::Matrix3d common = spread_.topLeftCorner<3, 3>();
  for (PlacedJoint& joint : points) joint.covariance += common;
  return points;
}

/// The joints of `now` take the place of those held; the others move with them.
void HeldBody::replace(const PlacedBody& now) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (now[j].placed) {
      body_[j] = now[j];
      unseen_[j] = 0.0;
    } else {
      body_[j].position += state_.head<3>();
    }
  }
  state_.head<3>().setZero();
}

}  // namespace chorus::fusion
