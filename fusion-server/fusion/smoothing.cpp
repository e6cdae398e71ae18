#include "fusion-server/fusion/smoothing.h"

#include <algorithm>

#include <Eigen/LU>

#include "fusion-server/fusion/joint_filters.h"
#include "fusion-server/fusion/motion_filter.h"

namespace chorus::fusion {
namespace {

/// What slow errors are at least of a stated variance.
constexpr double kLeastSlow = 0.1;

/// Position and velocity of a joint, one column per axis, and their covariance on each axis.
struct State {
  Eigen::Matrix<double, 2, 3> mean;
  Eigen::Matrix2d covariance;
};

const JointMotion& motion_of(const BodyAt& at, std::size_t joint) {
  return (*at.body->motion)[joint];
}

State state_of(const BodyAt& at, std::size_t joint) {
  const JointMotion& motion = motion_of(at, joint);
  State state;
  state.mean.row(0) = at.body->skeleton.joints[joint].position;
  state.mean.row(1) = motion.velocity;
  state.covariance << motion.place_variance, motion.shared, motion.shared, motion.variance;
  return state;
}

/// The bodies, from the first one on, that say something about the joint in the first: up to the
/// last measurement before it is lost.
std::span<const BodyAt> course_of(std::span<const BodyAt> bodies, std::size_t joint) {
  std::size_t measured = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].body->motion || !bodies[i].body->skeleton.joints[joint].seen()) break;
    if (i > 0 && bodies[i].instant - bodies[i - 1].instant > MotionFilter::kForgotten) break;
    if (motion_of(bodies[i], joint).measured) measured = i + 1;
  }
  return bodies.first(measured);
}

/// The state, given what is known of the next one.
State smoothed(const State& now, const State& next, double passed, double density) {
  Eigen::Matrix2d step;
  step << 1, passed, 0, 1;
  Eigen::Matrix2d noise;
  noise << passed * passed * passed / 3, passed * passed / 2, passed * passed / 2, passed;
  const Eigen::Matrix2d expected = step * now.covariance * step.transpose() + density * noise;
  const Eigen::Matrix2d gain = now.covariance * step.transpose() * expected.inverse();
  return {now.mean + gain * (next.mean - step * now.mean),
          now.covariance + gain * (next.covariance - expected) * gain.transpose()};
}

State smoothed(std::span<const BodyAt> course, std::size_t joint) {
  State state = state_of(course.back(), joint);
  for (std::size_t i = course.size() - 1; i-- > 0;) {
    const double passed = seconds(course[i + 1].instant - course[i].instant);
    // The next measurement tells whether the joint set off.
    const double density = motion_of(course[i + 1], joint).density;
    state = smoothed(state_of(course[i], joint), state, passed, density);
  }
  return state;
}

/// The factor for the stated covariance of the first body, which the filter's variance shrinks to
/// `left` [m^2].  The slow errors of the next measurement stay in any case.
double narrowed(std::span<const BodyAt> course, std::size_t joint, double left) {
  const double stated = course.front().body->variance[joint];
  const auto next = std::ranges::find_if(
      course, [joint](const BodyAt& at) { return motion_of(at, joint).measured; });
  const double then = next->body->variance[joint];
  const double slow = std::max(kLeastSlow * then, then - motion_of(*next, joint).place_variance);
  const double gained = motion_of(course.front(), joint).place_variance - left;
  return std::max(stated - gained, std::min(stated, slow)) / stated;
}

}  // namespace

FusedBody smoothed(std::span<const BodyAt> bodies) {
  const FusedBody& first = *bodies.front().body;
  FusedBody body = first;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto course = course_of(bodies, j);
    if (course.size() < 2 || !(first.variance[j] > 0)) continue;
    const State state = smoothed(course, j);
    FusedJoint joint{first.skeleton.joints[j], 0.0, first.contributors[j]};
    joint.shares = first.shares[j];
    joint.age = first.age[j];
    joint.joint.position = state.mean.row(0);
    JointMotion& motion = (*body.motion)[j];
    motion.velocity = state.mean.row(1);
    motion.variance = state.covariance(1, 1);
    state_covariance(joint,
                     narrowed(course, j, state.covariance(0, 0)) * joint.joint.covariance.matrix());
    put(body, static_cast<JointId>(j), joint);
  }
  return body;
}

}  // namespace chorus::fusion
