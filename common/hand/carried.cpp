#include "common/hand/carried.h"

#include <Eigen/Geometry>

namespace chorus::hand {
namespace {

/// What a pose counts after the next one: a mean over 900 poses, 15 s at 60 Hz.
constexpr double kKept = 1.0 - 1.0 / 900.0;

/// A direction in the horizontal plane as a complex number whose angle grows with a turn about +y;
/// short for one that points up or down, so that it counts little.
std::complex<double> level(const Eigen::Vector3d& direction) {
  return {direction.z(), direction.x()};
}

}  // namespace

double CarriedHand::heading(const Pose& pose, const Forearm& arm) {
  if (!take_.alone) return arm.heading;
  const Eigen::Vector3d forearm = (arm.wrist - arm.elbow).normalized();
  const Eigen::Vector3d pointing = pose.turn * Eigen::Vector3d::UnitY();
  const std::complex<double> turned = level(forearm) * std::conj(level(pointing));
  if (std::isfinite(turned.real()) && std::isfinite(turned.imag()))
    turned_ = kKept * turned_ + turned;
  return std::arg(turned_);
}

std::array<Eigen::Vector3d, kHandPoints> CarriedHand::at(double seconds, const Forearm& arm) {
  Pose pose = pose_at(take_, seconds);
  const Eigen::AngleAxisd turn(heading(pose, arm), Eigen::Vector3d::UnitY());
  pose.turn = turn * pose.turn;
  pose.wrist = arm.wrist;
  return joints_of(skeleton_, pose);
}

}  // namespace chorus::hand
