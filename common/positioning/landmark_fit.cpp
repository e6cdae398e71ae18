#include "common/positioning/landmark_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::positioning {
namespace {

using enum JointId;
using Across = Eigen::Matrix<double, 2, 3>;

/// How well a landmark tells a joint of the suit: the pose's error (3 degrees over the bones up to
/// the pelvis) and the landmark's offset from the joint, together, per axis [m].
struct Usable {
  JointId joint;
  double sigma;
};
constexpr std::array kUsable{
    Usable{HipLeft, 0.04},   Usable{HipRight, 0.04},      Usable{ShoulderLeft, 0.04},
    Usable{KneeLeft, 0.04},  Usable{ShoulderRight, 0.04}, Usable{KneeRight, 0.04},
    Usable{ElbowLeft, 0.05}, Usable{ElbowRight, 0.05},    Usable{AnkleLeft, 0.05},
    Usable{WristLeft, 0.06}, Usable{AnkleRight, 0.05},    Usable{WristRight, 0.06}};

constexpr double kRaySigma = 0.008;  // Of a ray that states none [rad].
constexpr double kInferred = 2.0;    // Factor on the error of inferred joints.
constexpr double kHuber = 1.5;
constexpr int kRounds = 10;
constexpr double kConverged = 1e-5;
constexpr double kNearest = 0.3;    // [m]
constexpr double kFarthest = 50.0;  // [m]
// Least determinant of the normal matrix of the start, relative to its mean diagonal cubed.
constexpr double kLeastSpread = 1e-4;
constexpr double kUsualDistance = 4.0;  // For the first weights [m].

struct Sighting {
  Eigen::Vector3d eye;
  Eigen::Vector3d ray;
  Across across;
  Eigen::Vector3d joint;  ///< Relative to SpineBase, at heading 0.
  double variance = 0.0;  ///< Of the joint, per axis [m^2].
  double ray_variance = 0.0;
};

Sighting sighting_of(const SeenRays& camera, const Joint& ray, const Joint& joint, double sigma) {
  Sighting one;
  one.eye = camera.world_from_sensor.translation();
  one.ray = (camera.world_from_sensor.linear() * ray.position).normalized();
  one.across.row(0) = one.ray.unitOrthogonal();
  one.across.row(1) = one.ray.cross(Eigen::Vector3d(one.across.row(0)));
  one.joint = joint.position;
  const double factor = ray.state == JointState::Inferred ? kInferred : 1.0;
  one.variance = std::pow(factor * sigma, 2);
  one.ray_variance =
      ray.covariance.known() ? ray.covariance.matrix().trace() / 2.0 : kRaySigma * kRaySigma;
  return one;
}

std::vector<Sighting> sightings_of(std::span<const SeenRays> cameras, const suit::SuitPose& pose) {
  std::vector<Sighting> seen;
  for (const SeenRays& camera : cameras) {
    for (const auto& [id, sigma] : kUsable) {
      const Joint& ray = camera.rays[id];
      const Joint& joint = pose.joints[id];
      if (ray.bears() && joint.seen()) seen.push_back(sighting_of(camera, ray, joint, sigma));
    }
  }
  return seen;
}

struct State {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  double heading = 0.0;

  [[nodiscard]] Eigen::Vector3d of(const Sighting& one) const {
    return about_y(heading) * one.joint + place - one.eye;
  }
};

double sigma_of(const Sighting& one, const State& state) {
  return std::sqrt(one.variance + state.of(one).squaredNorm() * one.ray_variance);
}

double off(const Sighting& one, const State& state) {
  return (one.across * state.of(one)).norm() / sigma_of(one, state);
}

/// The place that brings the joints nearest to their rays at this heading; none if all rays are
/// nearly parallel.
std::optional<State> start(const std::vector<Sighting>& seen, double heading) {
  State state;
  state.heading = heading;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const Eigen::Quaterniond turn = about_y(heading);
  for (const Sighting& one : seen) {
    const double variance = one.variance + kUsualDistance * kUsualDistance * one.ray_variance;
    const Eigen::Matrix3d across = one.across.transpose() * one.across / variance;
    normal += across;
    right += across * (one.eye - turn * one.joint);
  }
  if (!(normal.determinant() > kLeastSpread * std::pow(normal.trace() / 3.0, 3.0)))
    return std::nullopt;
  state.place = normal.inverse() * right;
  return state;
}

struct Normal {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
};

Normal normal_of(const std::vector<Sighting>& seen, const State& state, const HeadingPrior& prior) {
  Normal normal;
  for (const Sighting& one : seen) {
    const double sigma = sigma_of(one, state);
    const Eigen::Vector2d residual = one.across * state.of(one) / sigma;
    const double weight = residual.norm() > kHuber ? kHuber / residual.norm() : 1.0;
    const Eigen::Vector3d arm = about_y(state.heading) * one.joint;
    Eigen::Matrix<double, 2, 4> slope;
    slope.leftCols<3>() = one.across / sigma;
    slope.col(3) = one.across * Eigen::Vector3d(arm.z(), 0.0, -arm.x()) / sigma;
    normal.matrix += weight * slope.transpose() * slope;
    normal.right -= weight * slope.transpose() * residual;
  }
  const double information = 1.0 / (prior.sigma * prior.sigma);
  normal.matrix(3, 3) += information;
  normal.right[3] -= information * wrap_angle(state.heading - prior.heading);
  return normal;
}

bool refine(const std::vector<Sighting>& seen, const HeadingPrior& prior, State& state) {
  for (int round = 0; round < kRounds; ++round) {
    const Normal normal = normal_of(seen, state, prior);
    const Eigen::Vector4d by = normal.matrix.ldlt().solve(normal.right);
    if (!by.allFinite()) return false;
    state.place += by.head<3>();
    state.heading = wrap_angle(state.heading + by[3]);
    if (by.norm() < kConverged) break;
  }
  return true;
}

/// Huber's mean square of the residuals, per degree of freedom.
double misfit_of(const std::vector<Sighting>& seen, const State& state) {
  double sum = 0.0;
  for (const Sighting& one : seen) {
    const double r = off(one, state);
    sum += r <= kHuber ? r * r : 2.0 * kHuber * r - kHuber * kHuber;
  }
  const double freedom = std::max(1.0, 2.0 * static_cast<double>(seen.size()) - 4.0);
  return std::sqrt(sum / freedom);
}

bool stands_in_front(const std::vector<Sighting>& seen, const State& state) {
  return std::all_of(seen.begin(), seen.end(), [&](const Sighting& one) {
    const double depth = one.ray.dot(state.of(one));
    return depth > kNearest && depth < kFarthest;
  });
}

std::optional<LandmarkFit> fit(const std::vector<Sighting>& seen, const HeadingPrior& prior) {
  if (seen.size() < kFewestRays) return std::nullopt;
  auto state = start(seen, prior.heading);
  if (!state || !refine(seen, prior, *state) || !stands_in_front(seen, *state)) return std::nullopt;
  const Normal normal = normal_of(seen, *state, prior);
  const Eigen::Matrix4d covariance = normal.matrix.inverse();
  LandmarkFit out{state->place, state->heading, covariance, misfit_of(seen, *state), seen.size()};
  out.covariance *= std::max(1.0, out.misfit * out.misfit);
  if (!out.covariance.allFinite()) return std::nullopt;
  return out;
}

constexpr std::array kArm{ShoulderLeft, ElbowLeft, WristLeft};
constexpr std::array kLeg{HipLeft, KneeLeft, AnkleLeft};

}  // namespace

Skeleton<SensorSpace> relabelled(Skeleton<SensorSpace> rays, Exchanged what) {
  const auto exchange = [&](const auto& limb) {
    for (const JointId joint : limb) std::swap(rays[joint], rays[mirror(joint)]);
  };
  if (what == Exchanged::Arms || what == Exchanged::Everything) exchange(kArm);
  if (what == Exchanged::Legs || what == Exchanged::Everything) exchange(kLeg);
  return rays;
}

std::optional<LandmarkFit> fit_landmarks(std::span<const SeenRays> cameras,
                                         const suit::SuitPose& pose, const HeadingPrior& prior) {
  return fit(sightings_of(cameras, pose), prior);
}

std::optional<LandmarkFit> fit_any_heading(std::span<const SeenRays> cameras,
                                           const suit::SuitPose& pose) {
  const std::vector<Sighting> seen = sightings_of(cameras, pose);
  constexpr int kStarts = 12;
  constexpr double kFree = 1.0;  // [rad]
  std::optional<LandmarkFit> best;
  for (int i = 0; i < kStarts; ++i) {
    const double heading = wrap_angle(2.0 * std::numbers::pi * i / kStarts);
    const auto one = fit(seen, {heading, kFree});
    if (one && (!best || one->misfit < best->misfit)) best = one;
  }
  return best;
}

}  // namespace chorus::positioning
