// A skeleton of constant bones that follows a person: what BVH and glTF can carry.
//
// Fused joints are points, and the distances between them vary by centimetres.  Files of skeletal
// animation hold one rest pose and a rotation per joint and frame.  From the whole track:
//   bones    median length of each (Kinect bones, kBones); a joint that is never seen is left out
//            and its children hang on its parent;
//   rest     a T-pose: facing +z, arms along +-x, every rotation identity.  Where a joint has
//            several children (pelvis, chest, wrists) their rest directions are the mean shape,
//            found by turning that shape into every frame and averaging (generalised Procrustes,
//            three rounds from the T-pose);
//   frames   root position = SpineBase.  Down the tree, a joint with one child turns by the
//            shortest arc that points the bone at the fused child, seen from where the chain
//            stands; with several children, by the rotation that fits all of them best (Kabsch): so
//            pelvis and chest take their twist from the hip and shoulder lines, wrists from the
//            thumb.  The twist of arms, thighs and shins about themselves is not in the points and
//            stays zero against the parent.
// A joint that is not seen keeps its last local rotation; without SpineBase the whole pose is held.
// Before the first pose the first one is used.  Radians, metres, world space.
#pragma once

#include <vector>

#include "common/exporters/take.h"

namespace chorus::exporters {

struct FittedJoint {
  JointId id = JointId::SpineBase;
  std::size_t parent = 0;                            ///< Index; parents come first; 0 is the root.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< From the parent at rest [m].
};

struct FittedPose {
  Eigen::Vector3d root = Eigen::Vector3d::Zero();
  /// parent_from_joint, in order of the joints; continuous in sign from frame to frame.
  std::vector<Eigen::Quaterniond> turns;
};

/// How far the chain is from the fused joints it was made of.
struct FitResidual {
  double rms = 0.0;                    ///< Over all seen joints of all frames with a SpineBase [m].
  double largest = 0.0;                ///< [m]
  JointId joint = JointId::SpineBase;  ///< Which joint has the largest error,
  std::size_t frame = 0;               ///< and in which frame.
};

struct SkeletonFit {
  PersonId person;
  std::vector<FittedJoint> joints;
  std::vector<FittedPose> poses;  ///< One a frame of the track.
  FitResidual residual;
};

/// Refuses a person whose SpineBase is never seen.
[[nodiscard]] Result<SkeletonFit> fit_skeleton(const PersonTrack& track);

/// Where the joints of the chain are in a pose [m].
[[nodiscard]] std::vector<Eigen::Vector3d> chain_positions(const SkeletonFit& fit,
                                                           const FittedPose& pose);

/// Where they are at rest, SpineBase at the origin [m].
[[nodiscard]] std::vector<Eigen::Vector3d> rest_positions(const SkeletonFit& fit);

/// Half a bone farther in its direction: where a joint without children ends.  [m], from the joint.
[[nodiscard]] Eigen::Vector3d end_offset(const FittedJoint& leaf);

}  // namespace chorus::exporters
