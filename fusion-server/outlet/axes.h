// Axes and units of all output protocols.  Only this file converts them.
//
// Ours: world, right-handed, metres, +y up, +z in the master sensor's viewing direction unless
// `chorus origin` has turned the world, Hamilton quaternions.  docs/guide/outputs.md describes the
// wire formats.
#pragma once

#include <Eigen/Geometry>

namespace chorus::outlet {

/// x_in_target = scale * C * x_in_world, where C is `target_from_world`.  C is orthonormal, and a
/// reflection for left-handed targets; a rotation R becomes C R C^T, which is a rotation in either
/// case.
struct Axes {
  Eigen::Matrix3d target_from_world;
  double units_per_metre = 1.0;

  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3d& x_in_world) const {
    return units_per_metre * (target_from_world * x_in_world);
  }
  [[nodiscard]] Eigen::Matrix3d rotation(const Eigen::Quaterniond& world_from_joint) const {
    return target_from_world * world_from_joint.toRotationMatrix() * target_from_world.transpose();
  }
  /// The same rotation, as a quaternion with w >= 0.
  [[nodiscard]] Eigen::Quaterniond quaternion(const Eigen::Quaterniond& world_from_joint) const;
};

/// VRPN, ARVIDA, JSON: the world itself.  Right-handed, +y up, metres.
[[nodiscard]] const Axes& vrpn_axes();
/// DTrack "normal" room calibration: right-handed, +z up, millimetres: (x, -z, y).
[[nodiscard]] const Axes& dtrack_axes();
/// DTrack "powerwall" room calibration: right-handed, +y up, millimetres.
[[nodiscard]] const Axes& dtrack_powerwall_axes();
/// CAVELib/trackd: right-handed, +y up, feet.
[[nodiscard]] const Axes& trackd_axes();
/// Unity, VMC, VRChat: left-handed, +y up, +z forward, metres: (x, y, -z).
[[nodiscard]] const Axes& unity_axes();
/// Xsens MXTP: right-handed, +z up, metres: (z, x, y), so a body that faces +z looks along +x.
[[nodiscard]] const Axes& xsens_axes();
/// NatNet, as Motive streams it by default: right-handed, +y up, metres.
[[nodiscard]] const Axes& natnet_axes();

/// Rotates directions of a rest pose that looks along our +z, as that of Xsens and Motive does, to
/// the rest pose of our rig, which looks along -z (humanoid.h).
[[nodiscard]] const Eigen::Quaterniond& rig_from_ahead_rest();

/// The angles with R = Rx(eta) Ry(theta) Rz(phi), |theta| <= 90 deg (A.R.T. DTrack2 manual, App. B)
/// [rad].
[[nodiscard]] Eigen::Vector3d dtrack_angles(const Eigen::Matrix3d& rotation);
/// The angles with R = Ry(azimuth) Rx(elevation) Rz(roll), |elevation| <= 90 deg (CAVELib) [rad].
[[nodiscard]] Eigen::Vector3d trackd_angles(const Eigen::Matrix3d& rotation);
/// The angles (x, y, z) with R = Ry(y) Rx(x) Rz(z): Unity's Euler order, applied Z, X, Y [rad].
[[nodiscard]] Eigen::Vector3d unity_angles(const Eigen::Matrix3d& rotation);

}  // namespace chorus::outlet
