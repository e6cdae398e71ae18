// How a suit's sensors sit on their segments, and how long its bones are, by what cameras saw of a
// take whose places are known (Madaras et al., 7).  Pure.
//
// A segment that is turned by a constant against its sensor, and one of another length, differ from
// the suit's by a constant vector d_k in the segment's own axes.  So joints are
//   p_j = P + R_h (s_j + sum over the bones k up to j of q_k d_k)
// with the suit's joints s and orientations q, and the place P and heading h of the take.  All d
// are solved at once from the landmarks' rays by least squares with Huber's loss and a prior of
// zero, where each picture's place is free within kPlaceSigma.  Landmarks that lie beside the
// joints by a constant of their own cannot be told from bones of another length or direction: what
// such offsets may explain, or on which cameras disagree, stays as the suit has it; the rest is
// changed by less than what is seen, and the sigmas count both.
//
// A file without segments' rotations (BVH) has the orientations of motion/motion.h, made of bones:
// a turn about a bone is not seen in them.
#pragma once

#include <span>
#include <vector>

#include "common/positioning/take.h"

namespace chorus::positioning {

/// Shortest time of pictures with the person in them [s].
inline constexpr double kLeastWalk = 10.0;
/// What the place at one picture may be off [m].
inline constexpr double kPlaceSigma = 0.03;

struct BoneFound {
  JointId end = JointId::SpineBase;  ///< The joint that the bone ends in.
  double turn = 0.0;                 ///< From the suit's direction to the one found [rad].
  double turn_sigma = 0.0;
  double stretch = 1.0;  ///< Of the length found to the suit's.
  double stretch_sigma = 0.0;
};

struct Recalibration {
  /// What is added to each bone, in the axes of the segment that ends in the joint [m].
  std::array<Eigen::Vector3d, kJointCount> added = zeros();
  std::vector<BoneFound> bones;  ///< Those that could be solved.
  std::size_t pictures = 0;
  /// Median angle between landmarks' rays and the joints [rad].
  double before = 0.0;
  double after = 0.0;

  [[nodiscard]] static std::array<Eigen::Vector3d, kJointCount> zeros() {
    std::array<Eigen::Vector3d, kJointCount> out;
    out.fill(Eigen::Vector3d::Zero());
    return out;
  }
};

/// `take`: what place_take() made of these cameras; `start`: ClockSearch::start.
/// InvalidArgument when the person is seen for less than kLeastWalk, Unsupported when the suit
/// tells no orientations.
[[nodiscard]] Result<Recalibration> recalibrate(std::span<const CameraTake> cameras,
                                                const TakeResult& take, Timestamp start);

/// The pose with the bones that were found.
[[nodiscard]] suit::SuitPose recalibrated(const suit::SuitPose& pose, const Recalibration& found);

}  // namespace chorus::positioning
