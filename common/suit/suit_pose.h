// What an inertial suit knows: the pose of a person without a place.
#pragma once

#include <string>
#include <vector>

#include "common/base/duration.h"
#include "common/base/result.h"
#include "common/body/skeleton.h"
#include "common/motion/motion.h"

namespace chorus::suit {

/// +y up, origin at SpineBase; the heading is the suit's own, which drifts.  Metres.
struct SuitSpace;

struct SuitPose {
  Duration time{0};            ///< Since the beginning of the take or the stream.
  Skeleton<SuitSpace> joints;  ///< Relative to SpineBase.
  /// suit_from_pelvis: the rotation of the root, +y along the spine, +z ahead; all zero: not given.
  Eigen::Quaterniond root = Eigen::Quaterniond(0, 0, 0, 0);
};

/// A take: poses in time order.
struct SuitTake {
  double rate_hz = 0.0;
  std::vector<SuitPose> poses;
  /// Where the suit's own program says SpineBase was, y up [m]; as many as poses.
  std::vector<Eigen::Vector3d> claimed;
  std::vector<std::string> notes = {};  ///< What of the file was salvaged.
};

/// The pose of a body, without its place.  Joints that are not seen stay so; without SpineBase none
/// is.
[[nodiscard]] SuitPose pose_of(const Skeleton<WorldSpace>& body, Duration time);

/// A person's height, by the bones of one pose [m]: from the soles over legs and spine to the top
/// of the head.  Zero when joints on this way are missing.
[[nodiscard]] double stature_of(const SuitPose& pose);

/// The pose with all bones `factor` times as long.
[[nodiscard]] SuitPose scaled(const SuitPose& pose, double factor);

/// The body of a pose in the world: turned by `heading` about +y, SpineBase at `place` [m].
[[nodiscard]] Skeleton<WorldSpace> placed(const SuitPose& pose, double heading,
                                          const Eigen::Vector3d& place);

/// The pose at a time: interpolated linearly, constant outside the take.  Nothing is tracked in an
/// empty one.
[[nodiscard]] SuitPose pose_at(const SuitTake& take, Duration time);

/// Recorded motion without its place.  With a stature [m] above 0, all bones are scaled to it, by
/// the median of stature_of().  Refuses a motion without SpineBase in any frame, one whose
/// legs are missing, and one in which nothing moves for all of at least two seconds.
[[nodiscard]] Result<SuitTake> take_of(const motion::Motion& motion, double stature);

}  // namespace chorus::suit
