// Recorded human motion as 25 Kinect joints in world space: metres, y up.
#pragma once

#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/body/skeleton.h"
#include "common/motion/asf_amc.h"
#include "common/motion/bvh.h"
#include "common/motion/joint_names.h"

namespace chorus::motion {

struct Motion {
  double rate_hz = 0.0;
  std::vector<Skeleton<WorldSpace>> frames;
  /// Times of the frames [s], if the file states them; otherwise frame i is at i / rate_hz.
  std::vector<double> times = {};
};

/// The frame rate of the CMU library; AMC files do not state it.
inline constexpr double kCmuRateHz = 120.0;

/// One frame of a CMU skeleton as all 25 Kinect joints; hands, hand tips and thumbs are placed on
/// extensions of its bones.  The skeleton must have the CMU bones (see has_cmu_bones).
[[nodiscard]] Skeleton<WorldSpace> kinect_skeleton(const AsfSkeleton& skeleton,
                                                   const AmcFrame& frame);
[[nodiscard]] Result<void> has_cmu_bones(const AsfSkeleton& skeleton);

[[nodiscard]] Result<Motion> motion_from_amc(const AsfSkeleton& skeleton,
                                             const std::vector<AmcFrame>& frames,
                                             double rate_hz = kCmuRateHz);

/// Finds joints by name (joint_names.h): `chosen`, our own 25 names if the file has a SpineBase,
/// otherwise the names of the usual dialects.  A joint that the file lacks is not tracked; but in
/// those dialects spine, neck, hands and hand tips are inferred from their neighbours.  Frames that
/// the parser could not read show nobody.  Unsupported when there are not two joints; the error
/// lists the file's names.
[[nodiscard]] Result<Motion> motion_from_bvh(const Bvh& bvh, const JointChoice& chosen = {});

/// The names of a BVH file's joints, without end sites that no other joint needs.
[[nodiscard]] std::vector<std::string> names_in(const Bvh& bvh);

/// The skeleton at `time` [s] after the first frame: positions are interpolated linearly,
/// orientations by sign-aligned LERP.  Before the first and after the last frame it is constant.
/// If there are no frames, nothing is tracked.
[[nodiscard]] Skeleton<WorldSpace> at(const Motion& motion, double time);

/// True if the first frame is a separate T-pose, as Xsens MVN puts before the motion: nobody could
/// get from there to the second frame in one step.
[[nodiscard]] bool starts_with_pose(const Motion& motion);

/// Gives each joint the orientation of its segment: +y along the bone that ends there (at
/// SpineBase: along the bone to SpineMid), +z as near to the body's forward direction as possible.
/// Joints stay as they are if an end of that bone is not seen.  The orientations of head, hand
/// tips, thumbs and feet become all zero, as with a Kinect v2.
void orient_segments(Skeleton<WorldSpace>& body);

}  // namespace chorus::motion
