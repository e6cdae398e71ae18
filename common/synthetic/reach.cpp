#include "common/synthetic/reach.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace chorus::synthetic {
namespace {

// Largest distance of wrist and shoulder, as a share of the arm's length: nobody locks the elbow.
constexpr double kStraightest = 0.98;
// Smallest distance of wrist and shoulder, as a share of the arm's length.
constexpr double kClosest = 0.35;

struct Arm {
  JointId shoulder, elbow, wrist;
  std::array<JointId, 3> hand;
};

constexpr Arm kLeft{JointId::ShoulderLeft,
                    JointId::ElbowLeft,
                    JointId::WristLeft,
                    {JointId::HandLeft, JointId::HandTipLeft, JointId::ThumbLeft}};
constexpr Arm kRight{JointId::ShoulderRight,
                     JointId::ElbowRight,
                     JointId::WristRight,
                     {JointId::HandRight, JointId::HandTipRight, JointId::ThumbRight}};

void turn(Joint& joint, const Eigen::Quaterniond& rotation) {
  if (joint.orientation.squaredNorm() > 0) joint.orientation = rotation * joint.orientation;
}

/// Where the elbow is between shoulder and wrist, on the side of `hint`.
Eigen::Vector3d elbow_at(const Eigen::Vector3d& shoulder, const Eigen::Vector3d& wrist,
                         const std::array<double, 2>& bones, const Eigen::Vector3d& hint) {
  const Eigen::Vector3d way = wrist - shoulder;
  const double length = way.norm();
  const Eigen::Vector3d along = way / length;
  const double share = (length * length + bones[0] * bones[0] - bones[1] * bones[1]) / (2 * length);
  const double height = std::sqrt(std::max(0.0, bones[0] * bones[0] - share * share));
  Eigen::Vector3d aside = hint - shoulder;
  aside -= aside.dot(along) * along;
  return shoulder + share * along + height * aside.stableNormalized();
}

}  // namespace

void apply(const Reach& reach, Skeleton<WorldSpace>& body) {
  if (!(reach.amount > 0)) return;
  const Arm& arm = reach.left ? kLeft : kRight;
  const Eigen::Vector3d shoulder = body[arm.shoulder].position;
  const Eigen::Vector3d elbow = body[arm.elbow].position;
  const Eigen::Vector3d wrist = body[arm.wrist].position;
  const std::array bones{(elbow - shoulder).norm(), (wrist - elbow).norm()};
  const double length = bones[0] + bones[1];

  Eigen::Vector3d way = wrist + std::min(reach.amount, 1.0) * (reach.target - wrist) - shoulder;
  const double far = way.norm();
  way *= std::clamp(far, kClosest * length, kStraightest * length) / std::max(far, 1e-6);
  // The more the arm reaches, the more the elbow hangs below it instead of staying where it was.
  const Eigen::Vector3d below = shoulder + 0.5 * way - length * Eigen::Vector3d::UnitY();
  const Eigen::Vector3d hint = elbow + std::min(reach.amount, 1.0) * (below - elbow);
  const Eigen::Vector3d new_elbow = elbow_at(shoulder, shoulder + way, bones, hint);

  const auto upper = Eigen::Quaterniond::FromTwoVectors(elbow - shoulder, new_elbow - shoulder);
  const auto lower = Eigen::Quaterniond::FromTwoVectors(wrist - elbow, shoulder + way - new_elbow);
  body[arm.elbow].position = new_elbow;
  body[arm.wrist].position = shoulder + way;
  turn(body[arm.elbow], upper);
  turn(body[arm.wrist], lower);
  for (const JointId id : arm.hand) {
    body[id].position = shoulder + way + lower * (body[id].position - wrist);
    turn(body[id], lower);
  }
}

}  // namespace chorus::synthetic
