// Biovision BVH of one person: hierarchy, then a line of numbers a frame.
//
// Rest pose and rotations of skeleton_fit.h; joints by our names, the root's OFFSET is zero and its
// position channels say where SpineBase is.  Rotation channels are "Zrotation Xrotation Yrotation",
// that is parent_from_joint = Rz * Rx * Ry, degrees, unwrapped: of all triples that mean the same
// the one nearest to the frame before, so that curves can be interpolated.  World space, +y up.
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

/// z, x, y with q = Rz(z) * Rx(x) * Ry(y) [rad], nearest to `last` in the sum of their differences;
/// at x = +-90 deg, where z and y are about one axis, y stays.
[[nodiscard]] std::array<double, 3> euler_zxy(const Eigen::Quaterniond& q,
                                              const std::array<double, 3>& last);

}  // namespace chorus::exporters
