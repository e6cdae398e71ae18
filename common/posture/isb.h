// Joint angles as the International Society of Biomechanics recommends, for export.
//
// Wu et al. 2002 (J. Biomech. 35, 543-548: hip; knee after Grood & Suntay 1983) and 2005 (38,
// 981-992: shoulder, elbow).  Segment axes: X forward, Y up, Z right.  The left side is measured on
// the mirrored body, so both sides have the right side's signs.  Where a landmark of the
// recommendation is not tracked: the pelvis's Y is gravity, made square to the line between the
// hips; the thigh's and shank's Z is that line; the humerus has its second option (the plane of a
// bent elbow), so its axial rotation is NaN below 20 degrees of elbow flexion; the forearm's
// rotation is not measured.
#pragma once

#include <array>
#include <string_view>

#include "common/body/located.h"

namespace chorus::posture {

struct IsbRow {
  std::string_view name;                      ///< "leftShoulder"
  std::string_view sequence;                  ///< "YXY"
  std::array<std::string_view, 3> rotations;  ///< In the order of the sequence, with their sign.
  std::string_view source;
};

inline constexpr std::size_t kIsbJoints = 9;
[[nodiscard]] const std::array<IsbRow, kIsbJoints>& isb_rows();

/// Angles of each row [rad]; NaN where joints are not seen or the pose leaves them undefined.
using IsbAngles = std::array<std::array<double, 3>, kIsbJoints>;
[[nodiscard]] IsbAngles isb_angles(const Located& joints);

}  // namespace chorus::posture
