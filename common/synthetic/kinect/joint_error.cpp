#include "common/synthetic/kinect/joint_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/body/bones.h"
#include "common/synthetic/kinect/joint_noise_table.h"
#include "common/synthetic/kinect/leader.h"

namespace chorus::synthetic::kinect {
namespace {

enum Purpose : std::uint64_t { kOwn = 922, kCore, kTail, kState, kWhite, kTeleport, kHidden };

constexpr double kTurnUnit = deg(22.5);  // Angle that `turn_growth` refers to.

bool is_core(JointId id) { return mirror(id) == id; }

/// True for shoulders and hips, which are fixed to the trunk.
bool is_girdle(JointId id) {
  using enum JointId;
  return id == ShoulderLeft || id == ShoulderRight || id == HipLeft || id == HipRight;
}

bool is_foot(JointId id) {
  using enum JointId;
  return id == AnkleLeft || id == AnkleRight || id == FootLeft || id == FootRight;
}

double tau_of(JointId id, const ColouredError& coloured) {
  if (is_core(id)) return coloured.core_tau;
  return is_foot(id) ? coloured.foot_tau : coloured.limb_tau;
}

std::uint64_t block_of(double time, double length) {
  return static_cast<std::uint64_t>(std::max(0.0, std::floor(time / length)));
}

Eigen::Vector3d node(std::initializer_list<std::uint64_t> key, std::uint64_t block) {
  Draw keyed(key);
  return Draw{keyed.bits(), block}.gauss3();
}

/// A slowly varying factor that turns Gaussian noise into Student's t with unit variance.
double tail_scale(const ColouredError& coloured, double time, const ErrorKeys& keys,
                  std::size_t joint) {
  const double nu = coloured.student_nu;
  if (!(nu > 2)) return 1.0;
  const Eigen::Vector3d g = lattice_noise({kTail, keys.seed, keys.sensor, keys.person, joint}, time,
                                          std::max(coloured.tail_time, 1e-3));
  const double chi_square = g.squaredNorm() * nu / 3.0;
  return std::min(coloured.most_tail, std::sqrt((nu - 2.0) / std::max(chi_square, 1e-3)));
}

/// The factor on the table's standard deviations: it grows for the trunk where the SDK's yaw is
/// wrong (limbs are displaced or hidden there anyway), and for all joints away from the best
/// distance.
double growth(JointId id, const Stand& stand, const ColouredError& coloured) {
  const double turned = is_core(id) ? std::abs(stand.misjudged) / kTurnUnit : 0.0;
  const double off =
      std::max(0.0, std::abs(stand.distance - coloured.best_distance) - coloured.good_depth);
  return (1.0 + coloured.turn_growth * turned) * (1.0 + coloured.distance_growth * off * off);
}

/// Where inferred joints are pulled to: the bone hangs straight down from its parent.  Shoulders,
/// hips and joints without a seen parent stay where they are.
Eigen::Vector3d resting_place(const Skeleton<SensorSpace>& body, JointId id) {
  if (is_girdle(id)) return body[id].position;
  for (const Bone& bone : kBones) {
    if (bone.child != id || !body[bone.parent].seen()) continue;
    const Eigen::Vector3d& parent = body[bone.parent].position;
    return parent - (body[id].position - parent).norm() * Eigen::Vector3d::UnitY();
  }
  return body[id].position;
}

Eigen::Vector3d teleport(JointId id, double time, const GrossError& gross, const ErrorKeys& keys) {
  if (!(gross.teleports > 0) || !(gross.teleport_time > 0)) return Eigen::Vector3d::Zero();
  Draw draw{kTeleport,   keys.seed,    keys.sensor,
            keys.person, index_of(id), block_of(time, gross.teleport_time)};
  if (draw.uniform() >= gross.teleports * gross.teleport_time) return Eigen::Vector3d::Zero();
  return gross.teleport_size * draw.gauss3();
}

}  // namespace

Eigen::Vector3d lattice_noise(std::initializer_list<std::uint64_t> key, double time, double tau) {
  const double at = std::max(0.0, time / tau);
  const double s = at - std::floor(at);
  const std::uint64_t block = block_of(time, tau);
  // Interpolation reduces the variance between two nodes; this restores it to one.
  return ((1.0 - s) * node(key, block) + s * node(key, block + 1)) /
         std::sqrt((1.0 - s) * (1.0 - s) + s * s);
}

JointState shown_state(JointId id, double visible_share, double time, const Visibility& visibility,
                       const ErrorKeys& keys) {
  const double visible = is_core(id) || is_girdle(id) ? 0.0 : visibility.inferred_visible;
  const double chance =
      visible_share * visible + (1.0 - visible_share) * visibility.inferred_occluded;
  const std::uint64_t block = block_of(time, std::max(visibility.state_hold, 1e-3));
  Draw draw{kState, keys.seed, keys.sensor, keys.person, index_of(id), block};
  return draw.uniform() < chance ? JointState::Inferred : JointState::Tracked;
}

void SmoothNoise::advance(double passed, double tau, Draw draw) {
  const Eigen::Vector3d fresh = draw.gauss3();
  if (!started_) {  // Starts with the stationary distribution.
    first_ = fresh;
    second_ = 0.5 * (fresh + draw.gauss3());
    started_ = true;
    return;
  }
  const double keep = std::exp(-passed / std::max(0.5 * tau, 1e-3));
  first_ = keep * first_ + std::sqrt(1.0 - keep * keep) * fresh;
  second_ = keep * second_ + (1.0 - keep) * first_;
}

Eigen::Vector3d SmoothNoise::value() const {
  return std::numbers::sqrt2 * second_;  // The two filters halve the variance.
}

double activity(double speed, const ColouredError& coloured) {
  const double moving = std::clamp(speed / std::max(coloured.moving_speed, 1e-3), 0.0, 1.0);
  return coloured.rest_share + (1.0 - coloured.rest_share) * moving * moving;
}

void advance(ColouredState& state, const Stand& stand, const Moment& moment, const Profile& profile,
             const ErrorKeys& keys) {
  const ColouredError& coloured = profile.coloured;
  const auto stamp = static_cast<std::uint64_t>(std::max(0.0, moment.time * 1e6));
  for (std::size_t i = 0; i < kJointCount; ++i) {
    state.joint[i].advance(moment.dt * activity(stand.speed[i], coloured),
                           tau_of(static_cast<JointId>(i), coloured),
                           Draw{kOwn, keys.seed, keys.sensor, keys.person, i, stamp});
    // Unlike the others, the error of a hidden joint goes on changing while the body is at rest.
    state.hidden[i].advance(moment.dt, profile.visibility.hidden_tau,
                            Draw{kHidden, keys.seed, keys.sensor, keys.person, i, stamp});
  }
  const double core_speed = stand.speed[index_of(JointId::SpineShoulder)];
  state.shared.look(stand.view, coloured, {keys.seed, keys.person});
  state.core.advance(moment.dt * activity(core_speed, coloured), coloured.core_tau,
                     Draw{kCore, keys.seed, keys.sensor, keys.person, stamp});
}

namespace {

/// The coloured error of one joint, of unit variance, without what it follows of its leader.  It is
/// the sum of a part shared by the sensors that see the same side, a part common to the core
/// joints, and a part of its own.
Eigen::Vector3d own_unit(std::size_t i, const ColouredState& state, const ColouredError& coloured) {
  const double shared = static_cast<JointId>(i) == JointId::Neck ? coloured.neck_correlation
                                                                 : coloured.sensor_correlation;
  const double core =
      is_core(static_cast<JointId>(i)) ? coloured.core_correlation * (1.0 - shared) : 0.0;
  return std::sqrt(shared) * state.shared.of(static_cast<JointId>(i), coloured) +
         std::sqrt(core) * state.core.value() +
         std::sqrt(std::max(0.0, 1.0 - shared - core)) * state.joint[i].value();
}

/// The coloured error of one joint, of unit variance, with the part that follows its leader.
Eigen::Vector3d coloured_unit(std::size_t i, const ColouredState& state,
                              const ColouredError& coloured) {
  const auto led_by = leader(static_cast<JointId>(i));
  if (!led_by) return own_unit(i, state, coloured);
  return std::sqrt(coloured.follow_share) * own_unit(index_of(*led_by), state, coloured) +
         std::sqrt(1.0 - coloured.follow_share) * own_unit(i, state, coloured);
}

/// An error of unit variance, stretched along the ray to the joint.
Eigen::Vector3d stretched(const Eigen::Vector3d& unit, const Eigen::Vector3d& ray, double factor) {
  return unit + (factor - 1.0) * ray.dot(unit) * ray;
}

/// Standard deviations of the random errors of a seen joint, and the ray to it.
struct Sizes {
  double coloured = 0.0;  ///< Coloured error, across the ray [m].
  double hidden = 0.0;    ///< Error of a hidden joint, across the ray [m].
  Eigen::Vector3d white = Eigen::Vector3d::Zero();  ///< White noise, along the axes [m].
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
};

Eigen::Vector3d white_sigma(std::size_t i, const Stand& stand, const Profile& profile,
                            bool guessed) {
  const JointNoise& row = kJointNoise[i];
  const double size = std::abs(stand.view.facing);
  const double side = std::sin(std::min(size, deg(180)));
  const double ends = size < deg(90) ? row.rest_front : row.rest_rear;
  const double rest = ends + side * side * (row.rest_side - ends);
  const double moving = activity(stand.speed[i], profile.coloured);
  const Eigen::Vector3d walking(row.white_x, row.white_y, row.white_z);
  Eigen::Vector3d sigma = mm(1.0) * (Eigen::Vector3d::Constant(rest) +
                                     moving * (walking - Eigen::Vector3d::Constant(rest)));
  if (guessed) {
    const double more = moving * profile.white_inferred;
    sigma = (sigma.array().square() + more * more).sqrt();
  }
  return profile.white_scale * sigma;
}

Sizes sizes_of(std::size_t i, const Joint& joint, const Stand& stand, double time,
               const Profile& profile, const ErrorKeys& keys) {
  const ColouredError& coloured = profile.coloured;
  const bool guessed = joint.state == JointState::Inferred;
  double sigma = mm(kJointNoise[i].coloured) * coloured.scale *
                 growth(static_cast<JointId>(i), stand, coloured);
  if (guessed) sigma = std::max(sigma * coloured.inferred_factor, coloured.inferred_least);
  return {sigma * tail_scale(coloured, time, keys, i),
          mm(kJointNoise[i].hidden) * profile.visibility.hidden_scale * stand.hidden[i],
          white_sigma(i, stand, profile, guessed), joint.position.stableNormalized()};
}

/// Covariance of a stretched() error whose standard deviation across the ray is `sigma`.
Eigen::Matrix3d stretched_covariance(double sigma, const Eigen::Vector3d& ray, double factor) {
  return sigma * sigma *
         (Eigen::Matrix3d::Identity() + (factor * factor - 1.0) * ray * ray.transpose());
}

/// The displacement of an inferred joint towards its resting place.
Eigen::Vector3d pull(JointId id, const Skeleton<SensorSpace>& body, const ColouredError& coloured) {
  if (body[id].state != JointState::Inferred) return Eigen::Vector3d::Zero();
  return coloured.inferred_pull * (resting_place(body, id) - body[id].position);
}

}  // namespace

void add_errors(Skeleton<SensorSpace>& body, const ColouredState& state, const Stand& stand,
                double time, const Profile& profile, const ErrorKeys& keys) {
  const ColouredError& coloured = profile.coloured;
  const Skeleton<SensorSpace> exact = body;
  Draw white{kWhite, keys.seed, keys.sensor, keys.person,
             static_cast<std::uint64_t>(std::max(0.0, time * 1e6))};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    const Eigen::Vector3d white_draw = white.gauss3();
    Joint& joint = body.joints[i];
    if (!joint.seen()) continue;
    const Sizes sizes = sizes_of(i, exact.joints[i], stand, time, profile, keys);
    joint.position += pull(id, exact, coloured);
    joint.position += sizes.coloured * stretched(coloured_unit(i, state, coloured), sizes.ray,
                                                 coloured.depth_factor);
    joint.position += sizes.hidden * stretched(state.hidden[i].value(), sizes.ray,
                                               profile.visibility.hidden_depth);
    joint.position += sizes.white.cwiseProduct(white_draw);
    joint.position += teleport(id, time, profile.gross, keys);
  }
}

Eigen::Matrix3d error_moment(JointId id, const Skeleton<SensorSpace>& body, const Stand& stand,
                             double time, const Profile& profile, const ErrorKeys& keys) {
  const std::size_t i = index_of(id);
  const Sizes sizes = sizes_of(i, body[id], stand, time, profile, keys);
  const Eigen::Vector3d drawn = pull(id, body, profile.coloured);
  const Eigen::Vector3d thrown = teleport(id, time, profile.gross, keys);
  Eigen::Matrix3d moment =
      stretched_covariance(sizes.coloured, sizes.ray, profile.coloured.depth_factor) +
      stretched_covariance(sizes.hidden, sizes.ray, profile.visibility.hidden_depth) +
      drawn * drawn.transpose() + thrown * thrown.transpose();
  moment.diagonal() += sizes.white.cwiseAbs2();
  return moment;
}

}  // namespace chorus::synthetic::kinect
