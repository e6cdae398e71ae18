// Rotations: logarithm, exponential, distance, mean, yaw.  Radians; Hamilton quaternions.
//
// These functions accept any quaternion: a zero or non-finite one counts as identity or is ignored.
// q and -q are equivalent.
#pragma once

#include <span>

#include <Eigen/Geometry>

namespace chorus {

/// Unit quaternion nearest to q; identity when q is zero or not finite.
[[nodiscard]] Eigen::Quaterniond normalised_or_identity(const Eigen::Quaterniond& q);

/// True when all four parts are finite and the norm is within 1e-3 of 1.  False for the leaf joints
/// of the Kinect, whose orientation is 0 0 0 0.
[[nodiscard]] bool is_unit(const Eigen::Quaterniond& q);

/// Rotation vector of q: axis times angle, angle in [0, pi].
[[nodiscard]] Eigen::Vector3d log_map(const Eigen::Quaterniond& q);

/// Quaternion of a rotation vector, w >= 0.
[[nodiscard]] Eigen::Quaterniond exp_map(const Eigen::Vector3d& omega);

/// Angle between two rotations, in [0, pi].
[[nodiscard]] double angular_distance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// Sign-aligned linear interpolation, normalised (Otto 5.2.5 "LERP"); s in [0, 1].
[[nodiscard]] Eigen::Quaterniond lerp(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b,
                                      double s);

/// Weighted LERP of several rotations: sign-aligned to the heaviest, summed, normalised.  Ignores
/// non-unit entries and weights that are not positive; identity when none is left.
[[nodiscard]] Eigen::Quaterniond weighted_lerp(std::span<const Eigen::Quaterniond> rotations,
                                               std::span<const double> weights);

/// Rotation about +y by `yaw` [rad].
[[nodiscard]] Eigen::Quaterniond about_y(double yaw);

/// Yaw of b_from_a about +y: atan2(R(0,2), R(2,2)), i.e. the direction of the rotated +z axis in
/// the x-z plane.
[[nodiscard]] double yaw_of(const Eigen::Matrix3d& b_from_a);

/// Angle wrapped to (-pi, pi].
[[nodiscard]] double wrap_angle(double angle);

}  // namespace chorus
