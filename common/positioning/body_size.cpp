#include "common/positioning/body_size.h"

#include <cmath>
#include <optional>
#include <vector>

#include "common/base/median.h"
#include "common/body/bones.h"

namespace chorus::positioning {
namespace {

constexpr std::size_t kFewestFrames = 10;
constexpr double kEarShare = 0.925;
constexpr double kAnkleShare = 0.039;
constexpr double kEarSigma = 0.012;    // Of the former between people, relative.
constexpr double kPixelSigma = 0.006;  // Of a landmark [rad]: those of the head and ankles.
constexpr double kMostApart = 0.6;     // Between the ankles of who stands [m].
constexpr double kShortest = 0.5;      // Shortest and tallest people [m].
constexpr double kTallest = 2.5;

/// Where a ray from the eye crosses this height.
std::optional<Eigen::Vector3d> at_height(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray,
                                         double height) {
  const double along = (height - eye.y()) / ray.y();
  if (!std::isfinite(along) || !(along > 0.0)) return std::nullopt;
  return Eigen::Vector3d(eye + along * ray);
}

struct StandingRays {
  Eigen::Vector3d eye;
  Eigen::Vector3d head;
  Eigen::Vector3d left;
  Eigen::Vector3d right;
};

std::optional<StandingRays> standing_rays(const BodyFrame& body,
                                          const Eigen::Isometry3d& world_from_sensor) {
  const auto ray = [&](JointId id) -> std::optional<Eigen::Vector3d> {
    const Joint& joint = body.skeleton[id];
    if (!joint.given() || joint.state != JointState::Tracked) return std::nullopt;
    return Eigen::Vector3d(world_from_sensor.linear() * joint.position.stableNormalized());
  };
  const auto head = ray(JointId::Head);
  const auto left = ray(JointId::AnkleLeft);
  const auto right = ray(JointId::AnkleRight);
  if (!head || !left || !right) return std::nullopt;
  return StandingRays{world_from_sensor.translation(), *head, *left, *right};
}

/// How tall who stands there is; none if no upright person fits the rays.
std::optional<double> stature_by(const StandingRays& rays) {
  double stature = 1.75;
  for (int round = 0; round < 3; ++round) {
    const auto left = at_height(rays.eye, rays.left, kAnkleShare * stature);
    const auto right = at_height(rays.eye, rays.right, kAnkleShare * stature);
    if (!left || !right || (*left - *right).norm() > kMostApart) return std::nullopt;
    const Eigen::Vector3d stands = 0.5 * (*left + *right) - rays.eye;
    const Eigen::Vector2d there(stands.x(), stands.z());
    const Eigen::Vector2d towards(rays.head.x(), rays.head.z());
    const double along = there.dot(towards) / towards.squaredNorm();
    const double ear = rays.eye.y() + along * rays.head.y();
    stature = ear / kEarShare;
    if (!std::isfinite(stature) || !(along > 0.0) || stature < kShortest || stature > kTallest)
      return std::nullopt;
  }
  return stature;
}

/// The ray, turned up by the angle.
Eigen::Vector3d raised(const Eigen::Vector3d& ray, double angle) {
  const Eigen::Vector3d axis = ray.cross(Eigen::Vector3d::UnitY()).stableNormalized();
  return Eigen::AngleAxisd(angle, axis) * ray;
}

/// By the rays' errors and by how people differ; all pictures err alike.
double sigma_of(const StandingRays& rays, double stature) {
  const double step = 0.1 * kPixelSigma;
  StandingRays head = rays;
  head.head = raised(rays.head, step);
  StandingRays feet = rays;
  feet.left = raised(rays.left, step);
  feet.right = raised(rays.right, step);
  const double by_head = (stature_by(head).value_or(stature) - stature) / step;
  const double by_feet = (stature_by(feet).value_or(stature) - stature) / step;
  return std::hypot(kEarSigma * stature, kPixelSigma * by_head, kPixelSigma * by_feet);
}

}  // namespace

Result<LearnedLength> size_by_depth(std::span<const SensorFrame> frames) {
  std::array<std::vector<double>, kJointCount> lengths;
  for (const SensorFrame& frame : frames) {
    if (frame.bodies.empty()) continue;
    const Skeleton<SensorSpace>& body = frame.bodies.front().skeleton;
    for (const Bone& bone : kBones) {
      const Joint& a = body[bone.parent];
      const Joint& b = body[bone.child];
      if (a.seen() && b.seen() && b.state == JointState::Tracked)
        lengths[index_of(bone.child)].push_back((a.position - b.position).norm());
    }
  }
  BoneLengthOf bones{};
  for (std::size_t k = 0; k < kJointCount; ++k) {
    if (lengths[k].size() < kFewestFrames) continue;
    const double middle = median(lengths[k]);
    for (double& each : lengths[k]) each = std::abs(each - middle);
    constexpr double kSigmaOfMedian = 1.4826;  // Of a normal distribution, of absolute deviations.
    bones[k] = {middle, std::max(1e-4, kSigmaOfMedian * median(lengths[k]) /
                                           std::sqrt(static_cast<double>(lengths[k].size())))};
  }
  const auto stature = stature_of(bones);
  if (!stature)
    return fail(ErrorCode::NotFound, "size",
                "shank, thigh and spine are not seen as points in ten frames of the recording");
  return *stature;
}

Result<LearnedLength> size_by_picture(std::span<const SensorFrame> frames,
                                      const Eigen::Isometry3d& world_from_sensor) {
  std::vector<double> statures;
  std::vector<double> sigmas;
  for (const SensorFrame& frame : frames) {
    if (frame.bodies.empty()) continue;
    const auto rays = standing_rays(frame.bodies.front(), world_from_sensor);
    const auto stature = rays ? stature_by(*rays) : std::nullopt;
    if (!stature) continue;
    statures.push_back(*stature);
    sigmas.push_back(sigma_of(*rays, *stature));
  }
  if (statures.empty())
    return fail(ErrorCode::NotFound, "size",
                "nobody stands upright on the floor and is seen from head to foot");
  return LearnedLength{median(std::move(statures)), median(std::move(sigmas))};
}

}  // namespace chorus::positioning
