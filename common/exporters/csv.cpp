#include "common/exporters/csv.h"

#include <cmath>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/exporters/number_text.h"
#include "common/geometry/rotation.h"

namespace chorus::exporters {
namespace {

constexpr std::string_view kHeader =
    "frame,time_s,utc,person,joint,state,x_m,y_m,z_m,qx,qy,qz,qw,sd_mm\n";
constexpr std::array<std::string_view, 3> kStates{"NotTracked", "Inferred", "Tracked"};
constexpr int kMetreDigits = 6;
constexpr int kTurnDigits = 6;
constexpr int kDeviationDigits = 3;

void append_columns(std::string& row, const Joint& joint, double variance) {
  const JointState state = joint.seen() ? joint.state : JointState::NotTracked;
  row.append(",").append(kStates[static_cast<std::size_t>(state)]);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    row += ',';
    if (joint.seen()) append_fixed(row, joint.position[axis], kMetreDigits);
  }
  const bool turned = joint.seen() && is_unit(joint.orientation);
  for (Eigen::Index i = 0; i < 4; ++i) {
    row += ',';
    if (turned) append_fixed(row, joint.orientation.coeffs()[i], kTurnDigits);
  }
  row += ',';
  if (joint.seen() && variance >= 0)
    append_fixed(row, to_mm(std::sqrt(variance)), kDeviationDigits);
  row += '\n';
}

}  // namespace

std::string csv_of(const Take& take) {
  std::string text(kHeader);
  for (std::size_t f = 0; f < take.frames; ++f) {
    std::string start = std::to_string(f) + ",";
    append_fixed(start, static_cast<double>(f) / take.rate_hz, kTimeDigits);
    start += "," + to_iso8601(instant_of(take, f)) + ",";
    for (const PersonTrack& track : take.persons) {
      const std::string who = start + std::to_string(track.person.value) + ",";
      const Pose& pose = track.poses[f];
      for (std::size_t j = 0; j < kJointCount; ++j) {
        text.append(who).append(kJointNames[j]);
        append_columns(text, pose.skeleton.joints[j], pose.variance[j]);
      }
    }
  }
  return text;
}

}  // namespace chorus::exporters
