#include "common/synthetic/kinect/joint_error.h"

#include <algorithm>
#include <cmath>

#include "common/body/bones.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/kinect/joint_noise_table.h"

namespace chorus::synthetic::kinect {
namespace {

enum Purpose : std::uint64_t {
  kShared = 921,
  kOwn,
  kCore,
  kTail,
  kState,
  kWhite,
  kTeleport,
  kStart
};

constexpr double kBestDistance = 2.5;  // Otto Eq. (1) [m]
constexpr double kReliableTurn = deg(40);
constexpr double kTurnUnit = deg(50);
constexpr double kTailTau = 2.0;  // how long a bad spell lasts [s]
constexpr double kMostTail = 6.0;
constexpr double kTeleportTime = 0.1;   // [s]
constexpr double kWhiteInferred = 2.0;  // real logs: inferred joints are about twice as noisy

bool is_core(JointId id) { return mirror(id) == id; }

std::uint64_t block_of(double time, double length) {
  return static_cast<std::uint64_t>(std::max(0.0, std::floor(time / length)));
}

Eigen::Vector3d node(std::initializer_list<std::uint64_t> key, std::uint64_t block) {
  Draw keyed(key);
  return Draw{keyed.bits(), block}.gauss3();
}

/// Student t as a slowly varying scale on a Gaussian; unit variance.
double tail_scale(double nu, double time, const ErrorKeys& keys, std::size_t joint) {
  if (!(nu > 2)) return 1.0;
  const Eigen::Vector3d g =
      lattice_noise({kTail, keys.seed, keys.sensor, keys.person, joint}, time, kTailTau);
  const double chi_square = g.squaredNorm() * nu / 3.0;
  return std::min(kMostTail, std::sqrt((nu - 2.0) / std::max(chi_square, 1e-3)));
}

/// The error's standard deviation against the table's: turned away, off the best distance.
double growth(const Stand& stand, const ColouredError& coloured) {
  const double size = std::abs(stand.facing);
  const double turned = std::max(0.0, std::min(size, deg(180) - size) - kReliableTurn) / kTurnUnit;
  const double off = std::max(0.0, std::abs(stand.distance - kBestDistance) - 0.5);
  return (1.0 + coloured.turn_growth * turned) * (1.0 + coloured.distance_growth * off * off);
}

/// Where a guess is drawn to: the bone hanging straight down from its parent.
Eigen::Vector3d resting_place(const Skeleton<SensorSpace>& body, JointId id) {
  for (const Bone& bone : kBones) {
    if (bone.child != id || !body[bone.parent].seen()) continue;
    const Eigen::Vector3d& parent = body[bone.parent].position;
    return parent - (body[id].position - parent).norm() * Eigen::Vector3d::UnitY();
  }
  return body[id].position;
}

Eigen::Vector3d teleport(JointId id, double time, const GrossError& gross, const ErrorKeys& keys) {
  Draw draw{kTeleport,   keys.seed,    keys.sensor,
            keys.person, index_of(id), block_of(time, kTeleportTime)};
  if (draw.uniform() >= gross.teleports * kTeleportTime) return Eigen::Vector3d::Zero();
  return gross.teleport_size * draw.gauss3();
}

}  // namespace

Eigen::Vector3d lattice_noise(std::initializer_list<std::uint64_t> key, double time, double tau) {
  const double at = std::max(0.0, time / tau);
  const double s = at - std::floor(at);
  const std::uint64_t block = block_of(time, tau);
  // A straight line between two nodes has the least variance in the middle: scaled back to one.
  return ((1.0 - s) * node(key, block) + s * node(key, block + 1)) /
         std::sqrt((1.0 - s) * (1.0 - s) + s * s);
}

JointState shown_state(JointId id, double visible_share, double time, const Visibility& visibility,
                       const ErrorKeys& keys) {
  const double visible = is_core(id) ? 0.0 : visibility.inferred_visible;
  const double chance =
      visible_share * visible + (1.0 - visible_share) * visibility.inferred_occluded;
  const std::uint64_t block = block_of(time, std::max(visibility.state_hold, 1e-3));
  Draw draw{kState, keys.seed, keys.sensor, keys.person, index_of(id), block};
  return draw.uniform() < chance ? JointState::Inferred : JointState::Tracked;
}

void advance(ColouredState& state, double time, double dt, const ColouredError& coloured,
             const ErrorKeys& keys) {
  const auto stamp = static_cast<std::uint64_t>(std::max(0.0, time * 1e6));
  const auto move = [&](Eigen::Vector3d& value, double tau, Draw draw) {
    const double keep = state.started ? std::exp(-dt / std::max(tau, 1e-3)) : 0.0;
    value = keep * value + std::sqrt(1.0 - keep * keep) * draw.gauss3();
  };
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const double tau = is_core(static_cast<JointId>(i)) ? coloured.core_tau : coloured.limb_tau;
    move(state.joint[i], tau, Draw{kOwn, keys.seed, keys.sensor, keys.person, i, stamp});
  }
  move(state.core, coloured.core_tau, Draw{kCore, keys.seed, keys.sensor, keys.person, stamp});
  state.started = true;
}

void add_errors(Skeleton<SensorSpace>& body, const ColouredState& state, const Stand& stand,
                double time, const Profile& profile, const ErrorKeys& keys) {
  const ColouredError& coloured = profile.coloured;
  const double grown = growth(stand, coloured);
  const double shared_part = std::sqrt(coloured.sensor_correlation);
  const Skeleton<SensorSpace> exact = body;
  Draw white{kWhite, keys.seed, keys.sensor, keys.person,
             static_cast<std::uint64_t>(std::max(0.0, time * 1e6))};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    const Eigen::Vector3d white_draw = white.gauss3();
    Joint& joint = body.joints[i];
    if (!joint.seen()) continue;
    const bool guessed = joint.state == JointState::Inferred;
    const double core_part =
        is_core(id) ? std::sqrt(coloured.core_correlation * (1.0 - coloured.sensor_correlation))
                    : 0.0;
    const double own_part =
        std::sqrt(std::max(0.0, 1.0 - shared_part * shared_part - core_part * core_part));
    const double tau = is_core(id) ? coloured.core_tau : coloured.limb_tau;
    const Eigen::Vector3d unit =
        shared_part * lattice_noise({kShared, keys.seed, keys.person, i}, time, tau) +
        core_part * state.core + own_part * state.joint[i];
    double sigma = mm(kJointNoise[i].coloured) * coloured.scale * grown;
    if (guessed) {
      sigma = std::max(sigma * coloured.inferred_factor, coloured.inferred_least);
      joint.position += coloured.inferred_pull * (resting_place(exact, id) - joint.position);
    }
    const Eigen::Vector3d ray = exact.joints[i].position.stableNormalized();
    const Eigen::Vector3d along = ray.dot(unit) * ray;
    const double tail = tail_scale(coloured.student_nu, time, keys, i);
    joint.position += sigma * tail * (unit + (coloured.depth_factor - 1.0) * along);
    const Eigen::Vector3d white_sigma(kJointNoise[i].white_x, kJointNoise[i].white_y,
                                      kJointNoise[i].white_z);
    joint.position += mm(1.0) * profile.white_scale * (guessed ? kWhiteInferred : 1.0) *
                      white_sigma.cwiseProduct(white_draw);
    joint.position += teleport(id, time, profile.gross, keys);
  }
}

}  // namespace chorus::synthetic::kinect
