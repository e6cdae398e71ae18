// A skeleton with bones of constant length that follows a person; BVH and glTF can express only
// such skeletons.
//
// Fused joints are points, and the distances between them vary by centimetres.  Files of skeletal
// animation hold one rest pose and a rotation per joint and frame.  We derive from the whole track:
//   bones    the median length of each (Kinect bones, kBones); a joint that is never seen is left
//            out, and its children are attached to its parent;
//   rest     a T-pose: facing +z, arms along +-x, every rotation identity.  Where a joint has
//            several children (pelvis, chest, wrists), their rest directions are means over the
//            frames, each turned to fit the rest shape found so far (generalised Procrustes,
//            three rounds from the T-pose);
//   frames   root position = SpineBase.  From the root down, a joint with one child turns by the
//            shortest arc that points the bone at the fused child, seen from the joint's place in
//            the chain; a joint with several children takes the rotation that fits all of them
//            best (Kabsch), so pelvis and chest get their twist from the hip and shoulder lines,
//            wrists from the thumb.  The points do not show the twist of arms, thighs and shins
//            about themselves; it stays zero relative to the parent.
// A joint of which no child is seen keeps its last local rotation; without SpineBase the whole pose
// is kept.  Frames before the first pose use the first pose.  Radians, metres, world space.
#pragma once

#include <vector>

#include "common/exporters/take.h"

namespace chorus::exporters {

struct FittedJoint {
  JointId id = JointId::SpineBase;
  /// Index of the parent, which comes before its children; the root's is 0.
  std::size_t parent = 0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< From the parent, at rest [m].
};

struct FittedPose {
  Eigen::Vector3d root = Eigen::Vector3d::Zero();
  /// parent_from_joint, in the order of the joints; no sign jumps from frame to frame.
  std::vector<Eigen::Quaterniond> turns;
};

/// How far the chain is from the fused joints to which it was fitted.
struct FitResidual {
  double rms = 0.0;                    ///< Over all seen joints of all frames with a SpineBase [m].
  double largest = 0.0;                ///< [m]
  JointId joint = JointId::SpineBase;  ///< The joint with the largest error.
  std::size_t frame = 0;               ///< The frame with the largest error.
};

struct SkeletonFit {
  PersonId person;
  std::vector<FittedJoint> joints;
  std::vector<FittedPose> poses;  ///< One for each frame of the track.
  FitResidual residual;
};

/// Refuses a person whose SpineBase is never seen.
[[nodiscard]] Result<SkeletonFit> fit_skeleton(const PersonTrack& track);

/// Positions of the chain's joints in a pose [m].
[[nodiscard]] std::vector<Eigen::Vector3d> chain_positions(const SkeletonFit& fit,
                                                           const FittedPose& pose);

/// Positions of the chain's joints at rest, with SpineBase at the origin [m].
[[nodiscard]] std::vector<Eigen::Vector3d> rest_positions(const SkeletonFit& fit);

/// The end of a joint without children, relative to that joint [m]: half the bone's length farther
/// in the bone's direction.
[[nodiscard]] Eigen::Vector3d end_offset(const FittedJoint& leaf);

}  // namespace chorus::exporters
