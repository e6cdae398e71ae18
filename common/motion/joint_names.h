// Which of the points that another program names make which joint of ours: one normaliser and one
// table of dialects for BVH, C3D and TRC.
//
// A name is reduced to a side and a stem: "mixamorig:LeftUpLeg", "CC_Base_L_Thigh", "thigh.L" and
// "LThigh" become "l.upleg", "l.thigh", "l.thigh", "l.thigh".  The table (joint_names.cpp) lists,
// for each joint, stems of joint centres first and of skin markers last; skin markers and what is
// computed from them count as inferred.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/bones.h"

namespace chorus::motion {

/// A joint of ours, and the names of the points whose mean it is: what `--joints FILE` says.
using JointChoice = std::map<JointId, std::vector<std::string>>;

/// How a joint follows from its points.
enum class Placing {
  Mean,
  /// The hip joint centre from LASI, RASI and the pelvis' back (LPSI and RPSI, or the sacrum) by
  /// Bell, Pedersen and Brand (1990): from the middle of the two front spines 0.19 of their
  /// distance backwards, 0.30 downwards and 0.36 to the side.
  LeftHipOfPelvis,
  RightHipOfPelvis
};

struct JointSource {
  std::vector<std::size_t> points = {};  ///< Indices of names; empty: the file lacks this joint.
  JointState state = JointState::NotTracked;
  Placing placing = Placing::Mean;

  /// The joint's place; `places` are those of `points`.
  [[nodiscard]] Eigen::Vector3d placed(const std::vector<Eigen::Vector3d>& places) const;
};
using JointSources = std::array<JointSource, kJointCount>;

/// "l.thigh", "r.forearm", ".hips"; see above.
[[nodiscard]] std::string plain_name(std::string_view name);

/// The names without a prefix that at least 60 % of them share ("mixamorig:", "Bip01 ", "Anna_").
[[nodiscard]] std::vector<std::string> without_common_prefix(std::vector<std::string> names);

enum class Dialect {
  Joints,            ///< Names of joints alone: BVH.
  JointsAndMarkers,  ///< Also skin markers: C3D, TRC.
};

/// The sources of all joints.  `chosen` comes first, then our own names, then the table.  Names are
/// those of one subject.  Of equal names, the first counts.
[[nodiscard]] JointSources joint_sources(const std::vector<std::string>& names, Dialect dialect,
                                         const JointChoice& chosen = {});

[[nodiscard]] std::size_t count_found(const JointSources& sources);

/// Reads a file of lines "HipLeft = LASI, LPSI"; '#' begins a comment, an empty right side leaves
/// the joint to the table.  Refuses names that are no joint of ours, and repeated ones.
[[nodiscard]] Result<JointChoice> parse_joint_choice(std::string_view text,
                                                     std::string_view origin);

/// Such a file for these names: with what the table found, and all names as a comment.
[[nodiscard]] std::string joint_choice_template(const std::vector<std::string>& names,
                                                const JointSources& found);

/// The names in one line, at most 60 of them, for error messages.
[[nodiscard]] std::string names_shown(const std::vector<std::string>& names);

}  // namespace chorus::motion
