#include "common/exporters/trc.h"

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/exporters/number_text.h"

namespace chorus::exporters {
namespace {

constexpr int kRateDigits = 6;
constexpr int kCoordinateDigits = 5;  // decimals of millimetres

std::string properties(const Take& take, std::size_t markers) {
  std::string rate;
  append_fixed(rate, take.rate_hz, kRateDigits);
  const std::string frames = std::to_string(take.frames);
  return rate + "\t" + rate + "\t" + frames + "\t" + std::to_string(markers) + "\tmm\t" + rate +
         "\t1\t" + frames + "\n";
}

std::vector<NamedJoint> markers_of(ColumnNames names) {
  if (names == ColumnNames::Pose2Sim) return {kPose2SimMarkers.begin(), kPose2SimMarkers.end()};
  std::vector<NamedJoint> all;
  for (std::size_t j = 0; j < kJointCount; ++j)
    all.push_back({static_cast<JointId>(j), kJointNames[j]});
  return all;
}

void append_pose(std::string& text, const Pose& pose, const std::vector<NamedJoint>& names) {
  for (const NamedJoint& each : names) {
    const Joint& joint = pose.skeleton[each.joint];
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      text += '\t';
      if (joint.seen()) append_fixed(text, to_mm(joint.position[axis]), kCoordinateDigits);
    }
  }
}

}  // namespace

std::string trc_of(const Take& take, std::string_view file_name, ColumnNames names) {
  const std::vector<NamedJoint> joints = markers_of(names);
  const std::size_t markers = take.persons.size() * joints.size();
  std::string text = "PathFileType\t4\t(X/Y/Z)\t" + std::string(file_name) + "\n";
  text +=
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
      "OrigNumFrames\n";
  text += properties(take, markers);
  text += "Frame#\tTime";
  for (const PersonTrack& track : take.persons) {
    const std::string prefix = prefix_of(take, track);
    for (const NamedJoint& each : joints)
      text.append("\t").append(prefix).append(each.name).append("\t\t");
  }
  text += "\t\n\t";
  for (std::size_t m = 1; m <= markers; ++m) {
    for (const char axis : {'X', 'Y', 'Z'})
      text.append("\t").append(1, axis).append(std::to_string(m));
  }
  text += "\t\n\n";
  for (std::size_t f = 0; f < take.frames; ++f) {
    text += std::to_string(f + 1) + "\t";
    append_fixed(text, static_cast<double>(f) / take.rate_hz, kTimeDigits);
    for (const PersonTrack& track : take.persons) append_pose(text, track.poses[f], joints);
    text += "\t\n";
  }
  return text;
}

}  // namespace chorus::exporters
