#include "common/evaluation/limb_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

using inertial::kLimbCount;
using inertial::Limb;

/// How a limb's axes are made of joints.
struct LimbRow {
  JointId from, to;      ///< The bone: +y.
  JointId hinge, other;  ///< The neighbouring bone from the joint it shares; for the trunk the line
                         ///< across the body from right (`hinge`) to left (`other`).
  bool across;
  bool twist_shows;  ///< Whether these can show the limb's twist at all.
};

using enum JointId;
// clang-format off
constexpr std::array<LimbRow, kLimbCount> kRows{{
  {SpineBase, SpineMid, HipRight, HipLeft, true, true},
  {SpineMid, SpineShoulder, ShoulderRight, ShoulderLeft, true, true},
  {Neck, Head, ShoulderRight, ShoulderLeft, true, false},
  {ShoulderLeft, ElbowLeft, ElbowLeft, WristLeft, false, true},
  {ElbowLeft, WristLeft, ElbowLeft, ShoulderLeft, false, false},
  {WristLeft, HandLeft, WristLeft, ThumbLeft, false, true},
  {ShoulderRight, ElbowRight, ElbowRight, WristRight, false, true},
  {ElbowRight, WristRight, ElbowRight, ShoulderRight, false, false},
  {WristRight, HandRight, WristRight, ThumbRight, false, true},
  {HipLeft, KneeLeft, KneeLeft, AnkleLeft, false, true},
  {KneeLeft, AnkleLeft, KneeLeft, HipLeft, false, true},
  {AnkleLeft, FootLeft, AnkleLeft, KneeLeft, false, true},
  {HipRight, KneeRight, KneeRight, AnkleRight, false, true},
  {KneeRight, AnkleRight, KneeRight, HipRight, false, true},
  {AnkleRight, FootRight, AnkleRight, KneeRight, false, true},
}};
// The joint whose orientation is the limb's (motion/motion.h: of the bone that ends there).
constexpr std::array<JointId, kLimbCount> kEnds{
  SpineBase, SpineShoulder, Neck, ElbowLeft, WristLeft, HandLeft, ElbowRight, WristRight, HandRight,
  KneeLeft, AnkleLeft, FootLeft, KneeRight, AnkleRight, FootRight};
// clang-format on

constexpr double kUnseenTwist = std::numbers::pi;  // standard deviation of what is not seen [rad]
constexpr double kShortest = 1e-3;                 // of a bone or a lever [m]

Result<Eigen::Quaterniond> frame_of(const Eigen::Vector3d& along, const Eigen::Vector3d& aside) {
  const Eigen::Vector3d x = along.cross(aside);
  const double least = 1e-6 * along.norm() * aside.norm();
  if (!(x.norm() > least) || !(along.norm() > kShortest))
    return fail(ErrorCode::InvalidArgument, "limb",
                "its three points lie on one line: they show no orientation; choose others");
  Eigen::Matrix3d axes;
  axes.col(1) = along.normalized();
  axes.col(0) = x.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return normalised_or_identity(Eigen::Quaterniond(axes));
}

double sigma_of(const Joint& joint, double otherwise) {
  const double variance = joint.covariance.matrix().trace() / 3.0;
  return std::isfinite(variance) && variance > 0 ? std::sqrt(variance) : otherwise;
}

/// How far the other points of a limb stand off its bone: a short lever shows the twist badly.
double lever_of(const Eigen::Vector3d& along, const Eigen::Vector3d& aside) {
  return aside.cross(along.normalized()).norm();
}

/// Standard deviations about the limb's axes, in which swing and twist are independent.
Eigen::Matrix3d covariance_of(double sigma, double length, double lever) {
  const double swing = std::numbers::sqrt2 * sigma / std::max(length, kShortest);
  const double twist = std::numbers::sqrt2 * sigma / std::max(lever, kShortest);
  return Eigen::Vector3d(swing * swing, std::min(twist * twist, kUnseenTwist * kUnseenTwist),
                         swing * swing)
      .asDiagonal();
}

}  // namespace

Result<Eigen::Quaterniond> frame_of_points(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                           const Eigen::Vector3d& aside) {
  return frame_of(to - from, aside - from);
}

std::optional<TrackedOrientation> limb_from_joints(const Skeleton<WorldSpace>& body, Limb limb,
                                                   const LimbFrameOptions& options) {
  const LimbRow& row = kRows[inertial::index_of(limb)];
  if (!body[row.from].seen() || !body[row.to].seen()) return std::nullopt;
  const Eigen::Vector3d along = body[row.to].position - body[row.from].position;
  const bool beside = body[row.hinge].seen() && body[row.other].seen();
  Eigen::Vector3d aside = Eigen::Vector3d::Zero();
  if (beside) aside = body[row.other].position - body[row.hinge].position;
  const double sigma = std::max(sigma_of(body[row.from], options.joint_sigma),
                                sigma_of(body[row.to], options.joint_sigma));
  const double lever = lever_of(along, aside);
  TrackedOrientation out;
  out.twist_seen = row.twist_shows && lever > std::sin(options.least_bend) * aside.norm();
  auto frame = frame_of(along, aside);
  // Without anything beside the bone any twist does: it is not counted.
  if (!frame) frame = frame_of(along, Eigen::Vector3d::UnitZ());
  if (!frame) frame = frame_of(along, Eigen::Vector3d::UnitX());
  if (!frame) return std::nullopt;
  out.world_from_limb = *frame;
  out.covariance = covariance_of(sigma, along.norm(), out.twist_seen ? lever : 0.0);
  return out;
}

std::optional<TrackedOrientation> limb_from_orientation(const Skeleton<WorldSpace>& body,
                                                        Limb limb) {
  // What a body tracker's own orientations err by about each axis where it states nothing (real
  // Kinects: hips 2.5 to 8 degrees, forearms 50 and more).
  constexpr double kSigma = 0.15;
  const Joint& joint = body[end_joint_of(limb)];
  if (!joint.given() || !is_unit(joint.orientation)) return std::nullopt;
  return TrackedOrientation{joint.orientation.normalized(),
                            Eigen::Matrix3d::Identity() * kSigma * kSigma, true};
}

JointId end_joint_of(Limb limb) { return kEnds[inertial::index_of(limb)]; }

LimbBone bone_of(Limb limb) {
  const LimbRow& row = kRows[inertial::index_of(limb)];
  return {row.from, row.to};
}

}  // namespace chorus::evaluation
