// The table that says which points of an Xsens suit's segments make which Kinect v2 joint.
#include <algorithm>
#include <optional>

#include "common/motion/mvnx.h"

namespace chorus::motion {
namespace {

/// The direction of a bone in the axes of its segment (x ahead, y left, z up in the T-pose).
enum class Along { None, Up, Down, Left, Right };

struct SegmentRow {
  JointId joint;
  std::string_view segment;
  std::string_view point;  ///< A point of the segment; "": its origin.
  double share;            ///< Where the joint lies between the origin (0) and the point (1).
  /// Segment that has the orientation of the bone ending here; "": the joint gets none.
  std::string_view oriented;
  Along along;
};

// The places are those of a Kinect v2: Head in the head's middle, Hand in the palm, SpineShoulder
// at the neck's base.
// clang-format off
constexpr SegmentRow kSegmentRows[] = {
    {JointId::SpineBase,     "Pelvis",        "", 0, "Pelvis", Along::Up},
    {JointId::SpineMid,      "T12",           "", 0, "L5", Along::Up},
    {JointId::SpineShoulder, "Neck",          "", 0, "T8", Along::Up},
    {JointId::Neck,          "Neck",          "jC1Head", 0.5, "Neck", Along::Up},
    {JointId::Head,          "Head",          "pTopOfHead", 0.5, "", Along::None},
    {JointId::ShoulderLeft,  "LeftUpperArm",  "", 0, "LeftShoulder", Along::Left},
    {JointId::ElbowLeft,     "LeftForeArm",   "", 0, "LeftUpperArm", Along::Left},
    {JointId::WristLeft,     "LeftHand",      "", 0, "LeftForeArm", Along::Left},
    {JointId::HandLeft,      "LeftHand",      "pLeftTopOfHand", 0.5, "LeftHand", Along::Left},
    {JointId::HandTipLeft,   "LeftHand",      "pLeftTopOfHand", 1, "", Along::None},
    {JointId::ShoulderRight, "RightUpperArm", "", 0, "RightShoulder", Along::Right},
    {JointId::ElbowRight,    "RightForeArm",  "", 0, "RightUpperArm", Along::Right},
    {JointId::WristRight,    "RightHand",     "", 0, "RightForeArm", Along::Right},
    {JointId::HandRight,     "RightHand",     "pRightTopOfHand", 0.5, "RightHand", Along::Right},
    {JointId::HandTipRight,  "RightHand",     "pRightTopOfHand", 1, "", Along::None},
    {JointId::HipLeft,       "LeftUpperLeg",  "", 0, "Pelvis", Along::Left},
    {JointId::KneeLeft,      "LeftLowerLeg",  "", 0, "LeftUpperLeg", Along::Down},
    {JointId::AnkleLeft,     "LeftFoot",      "", 0, "LeftLowerLeg", Along::Down},
    {JointId::FootLeft,      "LeftToe",       "", 0, "", Along::None},
    {JointId::HipRight,      "RightUpperLeg", "", 0, "Pelvis", Along::Right},
    {JointId::KneeRight,     "RightLowerLeg", "", 0, "RightUpperLeg", Along::Down},
    {JointId::AnkleRight,    "RightFoot",     "", 0, "RightLowerLeg", Along::Down},
    {JointId::FootRight,     "RightToe",      "", 0, "", Along::None},
};
// clang-format on

/// Turns x ahead, y left, z up into ours: the person faces +z, left is +x, up is +y.
Eigen::Quaterniond world_from_xsens() {
  Eigen::Matrix3d turn;
  turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return Eigen::Quaterniond(turn);
}

/// Turns our joint axes (+y along the bone, +z ahead) into the axes of the segment.
Eigen::Quaterniond segment_from_joint(Along along) {
  Eigen::Vector3d y = Eigen::Vector3d::UnitZ();
  if (along == Along::Down) y = -Eigen::Vector3d::UnitZ();
  if (along == Along::Left) y = Eigen::Vector3d::UnitY();
  if (along == Along::Right) y = -Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitX();
  Eigen::Matrix3d axes;
  axes << y.cross(z), y, z;
  return Eigen::Quaterniond(axes);
}

struct SegmentSource {
  JointId joint;
  std::size_t segment = 0;
  Eigen::Vector3d in_segment = Eigen::Vector3d::Zero();
  std::optional<std::size_t> oriented;
  Eigen::Quaterniond segment_from_joint = Eigen::Quaterniond::Identity();
};

std::optional<std::size_t> segment_named(const Mvnx& mvnx, std::string_view label) {
  for (std::size_t i = 0; i < mvnx.segments.size(); ++i) {
    if (mvnx.segments[i].label == label) return i;
  }
  return std::nullopt;
}

std::optional<SegmentSource> source_of(const Mvnx& mvnx, const SegmentRow& row) {
  const auto segment = segment_named(mvnx, row.segment);
  if (!segment) return std::nullopt;
  SegmentSource source{row.joint, *segment, Eigen::Vector3d::Zero(), std::nullopt, {}};
  if (!row.point.empty()) {
    const auto& points = mvnx.segments[*segment].points;
    const auto found = std::find_if(points.begin(), points.end(),
                                    [&](const MvnxPoint& p) { return p.label == row.point; });
    if (found == points.end()) return std::nullopt;
    source.in_segment = row.share * found->in_segment;
  }
  if (!row.oriented.empty()) source.oriented = segment_named(mvnx, row.oriented);
  source.segment_from_joint = segment_from_joint(row.along);
  return source;
}

Skeleton<WorldSpace> skeleton_of(const MvnxFrame& frame,
                                 const std::vector<SegmentSource>& sources) {
  const Eigen::Quaterniond world = world_from_xsens();
  Skeleton<WorldSpace> body;
  for (const SegmentSource& source : sources) {
    Joint& joint = body[source.joint];
    joint.position = world * (frame.positions[source.segment] +
                              frame.orientations[source.segment] * source.in_segment);
    joint.state = JointState::Tracked;
    if (source.oriented)
      joint.orientation = world * frame.orientations[*source.oriented] * source.segment_from_joint;
  }
  return body;
}

}  // namespace

Result<Motion> motion_from_mvnx(const Mvnx& mvnx) {
  std::vector<SegmentSource> sources;
  for (const SegmentRow& row : kSegmentRows) {
    if (const auto source = source_of(mvnx, row)) sources.push_back(*source);
  }
  if (sources.empty() || sources.front().joint != JointId::SpineBase)
    return fail(ErrorCode::Unsupported, "MVNX segments", "there is no Pelvis among them");
  Motion motion{mvnx.rate_hz, {}};
  motion.frames.reserve(mvnx.frames.size());
  for (const MvnxFrame& frame : mvnx.frames) {
    motion.frames.push_back(skeleton_of(frame, sources));
    motion.times.push_back(frame.time);
  }
  return motion;
}

}  // namespace chorus::motion
