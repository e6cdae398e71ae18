// The measures of a body at one instant, from the places of its joints.
//
// World space: metres, +y against gravity.  Pelvis: left along the horizontal part of the line
// between the hips, up against gravity, forward = left x up.  Trunk: up from the middle of the hips
// to the middle of the shoulders, left along the line between the shoulders.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "common/body/located.h"
#include "common/posture/measures.h"

namespace chorus::posture {

/// Poses in which a measure is undefined.  It is then NaN instead of jumping.
struct Singular {
  bool hips_steep = false;       ///< The line between the hips is nearly vertical: no forward.
  bool trunk_level = false;      ///< The trunk lies sideways: no flexion.
  bool shoulders_steep = false;  ///< The line between the shoulders runs along the trunk: no twist.

  [[nodiscard]] bool any() const { return hips_steep || trunk_level || shoulders_steep; }
};

/// The part of a line that must remain in the plane in which its direction is measured; a direction
/// from a shorter one doubles the joints' errors at least.
inline constexpr double kLeastInPlane = 0.3;

struct Posture {
  Measures measures;
  Singular singular;
};

/// Head orientation (head axes to world; +y to the crown, +z to the face) if it is known: then
/// flexion and twist of the neck are those of the face, otherwise flexion is that of where the head
/// is and twist is unknown.  Side bend is always from where the head is.
[[nodiscard]] Posture posture_of(const Located& joints,
                                 const std::optional<Eigen::Quaterniond>& head = {});

}  // namespace chorus::posture
