#include "common/hand/glove_joints.h"

#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "common/base/median.h"

namespace chorus::hand {
namespace {

using Eigen::Vector3d;
using Residuals = std::array<Eigen::Vector2d, kHandJoints>;

constexpr double kNearestHand = 0.1;   // [m]
constexpr double kJointShare = 0.035;  // of a network's joint, relative to the hand's size in it
constexpr double kAlike = 5.0;         // Joints of one finger err alike.

/// In pixels.
Residuals residuals_of(const Joints& seen, const std::array<Vector3d, kHandJoints>& joints,
                       const Vector3d& wrist, const Intrinsics& camera) {
  Residuals out;
  for (std::size_t i = 0; i < kHandJoints; ++i) {
    const Vector3d at = joints[i] + wrist;
    out[i] = Eigen::Vector2d(camera.cx + camera.fx * at.x() / at.z(),
                             camera.cy + camera.fy * at.y() / at.z()) -
             seen[i];
  }
  return out;
}

struct Linear {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Vector3d vector = Vector3d::Zero();
};

/// fx (x + p) - (u - cx) (z + q) = 0, the same down; linear in the place.
Linear equations_of(const Joints& seen, const std::array<Vector3d, kHandJoints>& joints,
                    const Intrinsics& camera, const std::array<double, kHandJoints>& weights) {
  Linear out;
  for (std::size_t i = 0; i < kHandJoints; ++i) {
    Eigen::Matrix<double, 2, 3> rows;
    rows << camera.fx, 0.0, camera.cx - seen[i].x(), 0.0, camera.fy, camera.cy - seen[i].y();
    out.matrix += weights[i] * rows.transpose() * rows;
    out.vector -= weights[i] * rows.transpose() * (rows * joints[i]);
  }
  return out;
}

double spread_of(const Joints& seen) {
  double most = 0.0;
  for (const Pixel& each : seen) most = std::max(most, (each - seen[0]).norm());
  return most;
}

}  // namespace

Result<GlovePlace> place_by_joints(const Joints& seen, const PosedGlove& glove,
                                   const Intrinsics& camera, const GloveOptions& options) {
  if (!is_usable(glove)) return no_pose();
  for (const Pixel& each : seen) {
    if (!each.allFinite()) return fail(ErrorCode::InvalidArgument, "joints", "are not finite");
  }
  Pose pose = glove.pose;
  pose.wrist = Vector3d::Zero();
  const auto joints = joints_of(glove.skeleton, pose);
  const double sigma = std::max(1.0, kJointShare * spread_of(seen));  // [px]
  std::array<double, kHandJoints> weights;
  weights.fill(1.0);
  GlovePlace out;
  Linear linear;
  for (int round = 0; round < 4; ++round) {
    linear = equations_of(seen, joints, camera, weights);
    out.wrist = linear.matrix.ldlt().solve(linear.vector);
    if (!out.wrist.allFinite() || out.wrist.z() < kNearestHand)
      return fail(ErrorCode::NotFound, "glove", "the joints seen are not those of the pose told");
    const Residuals residuals = residuals_of(seen, joints, out.wrist, camera);
    std::vector<double> sizes;
    for (std::size_t i = 0; i < kHandJoints; ++i) {
      const double r = residuals[i].norm() / sigma;
      weights[i] = 1.0 / (1.0 + r * r);
      sizes.push_back(residuals[i].norm());
    }
    out.residual = median(std::move(sizes));
  }
  // The equations are in pixels times depth.
  const double by = sigma * out.wrist.z();
  out.covariance = kAlike * by * by * linear.matrix.inverse();
  out.facing = facing_of(glove, out.wrist);
  const double by_size = options.size_sigma * out.wrist.norm();
  const Vector3d sight = out.wrist.normalized();
  out.covariance += by_size * by_size * sight * sight.transpose();
  return out;
}

}  // namespace chorus::hand
