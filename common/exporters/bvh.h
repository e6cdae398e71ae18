// Biovision BVH of one person: the hierarchy, then one line of numbers per frame.
//
// skeleton_fit.h describes the rest pose and the rotations.  Joints have our names; the root's
// OFFSET is zero, and its position channels give SpineBase.  Rotation channels are "Zrotation
// Xrotation Yrotation", i.e. parent_from_joint = Rz * Rx * Ry, in degrees and unwrapped: of all
// equivalent triples we write the one nearest to the frame before, so that curves can be
// interpolated.  World space, +y up.
#pragma once

#include <array>
#include <string>

#include "common/exporters/skeleton_fit.h"

namespace chorus::exporters {

struct BvhOptions {
  double units_per_metre = 100.0;  ///< Centimetres, as Blender and MotionBuilder users expect.
};

[[nodiscard]] std::string bvh_of(const SkeletonFit& fit, double rate_hz,
                                 const BvhOptions& options = {});

/// The angles z, x, y with q = Rz(z) * Rx(x) * Ry(y) [rad]: the triple whose angles differ least
/// from `last` in total.  At x = +-90 deg, where z and y turn about the same axis, y is taken from
/// `last`.
[[nodiscard]] std::array<double, 3> euler_zxy(const Eigen::Quaterniond& q,
                                              const std::array<double, 3>& last);

}  // namespace chorus::exporters
