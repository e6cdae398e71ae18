#include "common/positioning/recalibrate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::positioning {
namespace {

constexpr double kEvery = 0.1;       // Between two pictures that are used [s].
constexpr double kAlike = 0.5;       // For so long landmarks err alike [s].
constexpr double kMarkSigma = 0.01;  // Of a landmark [rad].
constexpr double kOthers = 0.15;     // A ray farther from its joint is another person's [rad].
constexpr double kHuberLimit = 1.345;
constexpr int kPasses = 6;
// What is expected of a bone: ten degrees and as much of its length.
constexpr double kPriorShare = 0.17;
constexpr double kPriorLeast = 0.02;  // [m]
// A landmark's constant offset from its joint, per axis: what is left between BlazePose and Vicon's
// own pose in TotalCapture, which no suit's error explains (docs/benchmarks/positioner.md) [m].
constexpr double kLandmarkOffset = 0.0125;
// Chi-square of three numbers, 95 %: a bone that landmarks' offsets may explain stays as it is.
constexpr double kTold = 7.81;
constexpr std::size_t kUnknowns = 3 * kJointCount;

using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using BoneMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// A landmark's ray and the joint of the suit that it is of.
struct MarkRay {
  std::size_t joint = 0;
  Eigen::Vector3d eye;
  Eigen::Matrix<double, 2, 3> across;  ///< Two axes across the ray.
};

/// One picture: the suit's body in the world, and what a camera saw of it.
struct BodySight {
  std::array<Eigen::Vector3d, kJointCount> at;    ///< Of the suit, placed [m].
  std::array<Eigen::Matrix3d, kJointCount> turn;  ///< world_from_segment.
  std::array<bool, kJointCount> turned{};
  std::vector<MarkRay> rays;
  std::size_t camera = 0;
};

Eigen::Matrix<double, 2, 3> two_across(const Eigen::Vector3d& ray) {
  Eigen::Matrix<double, 2, 3> out;
  out.row(0) = ray.unitOrthogonal();
  out.row(1) = ray.cross(Eigen::Vector3d(out.row(0).transpose()));
  return out;
}

BodySight sight_of(const Placed& placed_pose) {
  BodySight sight;
  const Skeleton<WorldSpace> body =
      placed(placed_pose.pose, placed_pose.smooth.heading, placed_pose.smooth.place);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    sight.at[j] = body.joints[j].position;
    sight.turned[j] = body.joints[j].seen() && is_unit(body.joints[j].orientation);
    if (sight.turned[j]) sight.turn[j] = body.joints[j].orientation.toRotationMatrix();
  }
  return sight;
}

struct SeenMarks {
  std::vector<MarkRay> rays;
  double misfit = kOthers;  ///< Median angle [rad].
};

SeenMarks seen_marks(const BodyFrame& body, const CameraTake& camera, const Placed& truth,
                     const BodySight& sight) {
  SeenMarks out;
  std::vector<double> angles;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Joint& seen = body.skeleton.joints[j];
    if (!seen.given() || !truth.pose.joints.joints[j].seen()) continue;
    const Eigen::Vector3d ray =
        camera.world_from_sensor.linear() * seen.position.stableNormalized();
    const Eigen::Vector3d eye = camera.world_from_sensor.translation();
    const double angle =
        std::acos(std::clamp(ray.dot((sight.at[j] - eye).stableNormalized()), -1.0, 1.0));
    angles.push_back(angle);
    out.rays.push_back({j, eye, two_across(ray)});
  }
  constexpr std::size_t kFewest = 6;
  if (angles.size() >= kFewest) out.misfit = median(std::move(angles));
  return out;
}

/// All pictures that are used.
std::vector<BodySight> sights_of(std::span<const CameraTake> cameras, const TakeResult& take,
                                 Timestamp start) {
  const std::vector<Placed>& placed = take.placed;
  std::vector<BodySight> out;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const CameraTake& camera = cameras[c];
    double last = -kEvery;
    for (const SensorFrame& frame : camera.frames) {
      const Duration at = frame.captured - start - from_seconds(take.clocks.ahead(c));
      if (seconds(at) - last < 0.99 * kEvery) continue;
      const auto near = std::ranges::lower_bound(placed, at, {}, &Placed::time);
      if (near == placed.end() || std::abs(seconds(near->time - at)) > kEvery) continue;
      BodySight sight = sight_of(*near);
      SeenMarks best;
      for (const BodyFrame& body : frame.bodies) {
        SeenMarks one = seen_marks(body, camera, *near, sight);
        if (one.misfit < best.misfit) best = std::move(one);
      }
      if (best.rays.empty()) continue;
      sight.rays = std::move(best.rays);
      sight.camera = c;
      out.push_back(std::move(sight));
      last = seconds(at);
    }
  }
  return out;
}

/// Where a joint is with the bones that are added.
Eigen::Vector3d bone_moved(const BodySight& sight, std::size_t joint, const Unknowns& added) {
  Eigen::Vector3d at = sight.at[joint];
  for (std::size_t k = joint; k != index_of(JointId::SpineBase);
       k = index_of(parent_of(static_cast<JointId>(k)))) {
    if (sight.turned[k]) at += sight.turn[k] * added.segment<3>(static_cast<Eigen::Index>(3 * k));
  }
  return at;
}

/// Adds one picture to the normal equations; its place is eliminated.
void add(const BodySight& sight, const Unknowns& added, BoneMatrix& a, Unknowns& b) {
  BoneMatrix own = BoneMatrix::Zero();
  Unknowns right = Unknowns::Zero();
  Eigen::Matrix<double, kUnknowns, 3> mixed = Eigen::Matrix<double, kUnknowns, 3>::Zero();
  Eigen::Matrix3d place = Eigen::Matrix3d::Identity() / (kPlaceSigma * kPlaceSigma);
  Eigen::Vector3d place_right = Eigen::Vector3d::Zero();
  for (const MarkRay& ray : sight.rays) {
    const Eigen::Vector3d from_eye = bone_moved(sight, ray.joint, added) - ray.eye;
    const double sigma = kMarkSigma * std::max(from_eye.norm(), 0.1);
    const Eigen::Vector2d off = ray.across * from_eye / sigma;
    const double weight = std::min(1.0, kHuberLimit / std::max(off.norm(), 1e-9)) * kEvery / kAlike;
    const Eigen::Matrix<double, 2, 3> slope = ray.across / sigma;
    Eigen::Matrix<double, 2, kUnknowns> all = Eigen::Matrix<double, 2, kUnknowns>::Zero();
    for (std::size_t k = ray.joint; k != index_of(JointId::SpineBase);
         k = index_of(parent_of(static_cast<JointId>(k)))) {
      if (sight.turned[k])
        all.middleCols<3>(static_cast<Eigen::Index>(3 * k)) = slope * sight.turn[k];
    }
    own.noalias() += weight * all.transpose() * all;
    mixed.noalias() += weight * all.transpose() * slope;
    place += weight * slope.transpose() * slope;
    right -= weight * all.transpose() * off;
    place_right -= weight * slope.transpose() * off;
  }
  const Eigen::Matrix3d solved = place.inverse();
  a += own - mixed * solved * mixed.transpose();
  b += right - mixed * (solved * place_right);
}

double median_angle(const std::vector<BodySight>& sights, const Unknowns& added) {
  std::vector<double> angles;
  for (const BodySight& sight : sights)
    for (const MarkRay& ray : sight.rays) {
      const Eigen::Vector3d from_eye = bone_moved(sight, ray.joint, added) - ray.eye;
      angles.push_back(std::asin(
          std::min(1.0, (ray.across * from_eye).norm() / std::max(from_eye.norm(), 1e-9))));
    }
  return angles.empty() ? 0.0 : median(std::move(angles));
}

/// The suit's bone that ends in each joint, in its segment's axes; zero: not known.
std::array<Eigen::Vector3d, kJointCount> bones_of(const std::vector<BodySight>& sights) {
  auto bones = Recalibration::zeros();
  std::array<double, kJointCount> counts{};
  for (const BodySight& sight : sights) {
    for (const Bone& bone : kBones) {
      const std::size_t k = index_of(bone.child);
      if (!sight.turned[k]) continue;
      bones[k] += sight.turn[k].transpose() * (sight.at[k] - sight.at[index_of(bone.parent)]);
      ++counts[k];
    }
  }
  for (std::size_t k = 0; k < kJointCount; ++k)
    if (counts[k] > 0.0) bones[k] /= counts[k];
  return bones;
}

/// What is expected of a bone of this length, per axis [m].
double prior_sigma(double length) { return std::max(kPriorShare * length, kPriorLeast); }

struct Solved {
  Unknowns added;
  BoneMatrix covariance;
};

Solved solved(const std::vector<BodySight>& sights,
              const std::array<Eigen::Vector3d, kJointCount>& bones) {
  Unknowns added = Unknowns::Zero();
  BoneMatrix covariance = BoneMatrix::Identity();
  for (int round = 0; round < kPasses; ++round) {
    BoneMatrix a = BoneMatrix::Zero();
    Unknowns b = Unknowns::Zero();
    for (const BodySight& sight : sights) add(sight, added, a, b);
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const double length = bones[static_cast<std::size_t>(i / 3)].norm();
      const double sigma = prior_sigma(length);
      a(i, i) += 1.0 / (sigma * sigma);
      b[i] -= added[i] / (sigma * sigma);
    }
    const Eigen::LDLT<BoneMatrix> solver(a);
    added += solver.solve(b);
    covariance = solver.solve(BoneMatrix::Identity());
  }
  return {added, covariance};
}

/// How far cameras (or quarters of the take of a single one) disagree on each bone, as the
/// covariance of their mean [m^2]: a network guesses limbs that it does not see, from each side
/// otherwise.
std::array<Eigen::Matrix3d, kJointCount> disagreement(
    const std::vector<BodySight>& sights, std::size_t cameras,
    const std::array<Eigen::Vector3d, kJointCount>& bones) {
  constexpr std::size_t kQuarters = 4;
  const std::size_t groups = cameras > 1 ? cameras : kQuarters;
  std::vector<std::vector<BodySight>> parts(groups);
  for (std::size_t i = 0; i < sights.size(); ++i)
    parts[cameras > 1 ? sights[i].camera : i * groups / sights.size()].push_back(sights[i]);
  std::erase_if(parts, [](const auto& part) { return part.empty(); });
  std::vector<Unknowns> each;
  for (const auto& part : parts) each.push_back(solved(part, bones).added);
  std::array<Eigen::Matrix3d, kJointCount> out;
  out.fill(Eigen::Matrix3d::Zero());
  if (each.size() < 2) return out;
  const auto count = static_cast<double>(each.size());
  Unknowns mean = Unknowns::Zero();
  for (const Unknowns& one : each) mean += one / count;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (const Unknowns& one : each) {
      const Eigen::Vector3d off = (one - mean).segment<3>(static_cast<Eigen::Index>(3 * j));
      out[j] += off * off.transpose() / (count * (count - 1.0));
    }
  }
  return out;
}

struct BoneChange {
  Eigen::Vector3d added = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// What is left of a change when landmarks at both ends of the bone lie beside their joints.
BoneChange beyond_offsets(const Eigen::Vector3d& added, const Eigen::Matrix3d& covariance,
                          double length) {
  const Eigen::Matrix3d offsets = 2.0 * std::pow(kLandmarkOffset, 2) * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d seen = covariance + offsets;
  const Eigen::Matrix3d prior = std::pow(prior_sigma(length), 2) * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d gain = prior * (prior + seen).inverse();
  BoneChange out{gain * added, gain * seen};
  if (added.dot(seen.ldlt().solve(added)) < kTold) out.added.setZero();
  return out;
}

BoneFound found_of(JointId end, const Eigen::Vector3d& bone, const Eigen::Vector3d& added,
                   const Eigen::Matrix3d& covariance) {
  BoneFound out{end};
  const double length = bone.norm();
  const Eigen::Vector3d along = bone / length;
  const Eigen::Vector3d now = bone + added;
  out.turn = std::acos(std::clamp(along.dot(now.stableNormalized()), -1.0, 1.0));
  out.stretch = now.norm() / length;
  const double lengthwise = along.dot(covariance * along);
  out.stretch_sigma = std::sqrt(lengthwise) / length;
  out.turn_sigma = std::sqrt(0.5 * std::max(0.0, covariance.trace() - lengthwise)) / length;
  return out;
}

}  // namespace

Result<Recalibration> recalibrate(std::span<const CameraTake> cameras, const TakeResult& take,
                                  Timestamp start) {
  const std::vector<BodySight> sights = sights_of(cameras, take, start);
  const double walked = kEvery * static_cast<double>(sights.size()) /
                        static_cast<double>(std::max<std::size_t>(cameras.size(), 1));
  if (walked < kLeastWalk)
    return fail(ErrorCode::InvalidArgument, "recalibration",
                fmt::format("the person is seen for {:.0f} s; walk about before the cameras for a "
                            "minute, turning to all sides ({:.0f} s at least)",
                            walked, kLeastWalk));
  const auto bones = bones_of(sights);
  const auto known = [&](const Bone& bone) { return bones[index_of(bone.child)].norm() > 1e-3; };
  if (std::ranges::none_of(kBones, known))
    return fail(ErrorCode::Unsupported, "recalibration", "the suit tells no segment's orientation");
  const auto [added, covariance] = solved(sights, bones);
  Recalibration out;
  out.pictures = sights.size();
  out.before = median_angle(sights, Unknowns::Zero());
  const auto apart = disagreement(sights, cameras.size(), bones);
  Unknowns kept = Unknowns::Zero();
  for (const Bone& bone : kBones) {
    if (!known(bone)) continue;
    const auto k = static_cast<Eigen::Index>(3 * index_of(bone.child));
    const Eigen::Vector3d& before = bones[index_of(bone.child)];
    const Eigen::Matrix3d seen = covariance.block<3, 3>(k, k) + apart[index_of(bone.child)];
    const BoneChange change = beyond_offsets(added.segment<3>(k), seen, before.norm());
    kept.segment<3>(k) = out.added[index_of(bone.child)] = change.added;
    out.bones.push_back(found_of(bone.child, before, change.added, change.covariance));
  }
  out.after = median_angle(sights, kept);
  return out;
}

suit::SuitPose recalibrated(const suit::SuitPose& pose, const Recalibration& found) {
  suit::SuitPose out = pose;
  for (const Bone& bone : kBones) {
    const std::size_t k = index_of(bone.child);
    const std::size_t parent = index_of(bone.parent);
    const Joint& before = pose.joints.joints[k];
    if (!before.seen() || !pose.joints.joints[parent].seen()) continue;
    Eigen::Vector3d vector = before.position - pose.joints.joints[parent].position;
    if (is_unit(before.orientation)) vector += before.orientation * found.added[k];
    out.joints.joints[k].position = out.joints.joints[parent].position + vector;
  }
  return out;
}

}  // namespace chorus::positioning
