// Recorded human motion as 25 Kinect joints in world space: metres, y up.
#pragma once

#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/body/skeleton.h"
#include "common/motion/asf_amc.h"
#include "common/motion/bvh.h"

namespace chorus::motion {

struct Motion {
  double rate_hz = 0.0;
  std::vector<Skeleton<WorldSpace>> frames;
};

/// The CMU library records at this rate; AMC files do not say.
inline constexpr double kCmuRateHz = 120.0;

/// One frame of a CMU skeleton as Kinect joints.  All 25; hands, tips and thumbs are extended along
/// the bones the skeleton has.  The skeleton must have the CMU bones (see has_cmu_bones).
[[nodiscard]] Skeleton<WorldSpace> kinect_skeleton(const AsfSkeleton& skeleton,
                                                   const AmcFrame& frame);
[[nodiscard]] Result<void> has_cmu_bones(const AsfSkeleton& skeleton);

[[nodiscard]] Result<Motion> motion_from_amc(const AsfSkeleton& skeleton,
                                             const std::vector<AmcFrame>& frames,
                                             double rate_hz = kCmuRateHz);

/// Knows the joint names of the usual BVH dialects, and our own 25 names, used when there is a
/// SpineBase.  A joint without a counterpart in the file is not tracked or, in dialects other than
/// ours, inferred from its neighbours; those files are refused without hips, knees, shoulders,
/// elbows or a neck.
[[nodiscard]] Result<Motion> motion_from_bvh(const Bvh& bvh);

/// The skeleton at `time` [s] after the first frame: positions linear, orientations sign-aligned
/// LERP; held at both ends.  For a motion without frames nothing is tracked.
[[nodiscard]] Skeleton<WorldSpace> at(const Motion& motion, double time);

/// Gives each joint the orientation of its segment: +y along the bone that ends there, +z as near
/// to the body's forward as that allows.  Head, hand tips, thumbs and feet stay all-zero, as Kinect
/// v2 leaves them.
void orient_segments(Skeleton<WorldSpace>& body);

}  // namespace chorus::motion
