#include "fusion-server/natnet/natnet_encoder.h"

#include <string>

#include "common/base/duration.h"
#include "common/body/bones.h"
#include "fusion-server/natnet/natnet_messages.h"
#include "fusion-server/outlet/axes.h"

namespace chorus::natnet {
namespace {

constexpr std::uint32_t kRigidBody = 1;
constexpr std::uint32_t kSkeleton = 2;
constexpr std::int32_t kNoParent = -1;
constexpr std::uint32_t kNone = 0;
constexpr std::int16_t kTracked = 1;
constexpr std::int16_t kModelsChanged = 2;

std::int32_t rigid_body_id(std::size_t slot, std::size_t joint) {
  return static_cast<std::int32_t>(kJointCount * slot + joint + 1);
}

std::int32_t skeleton_id(std::size_t slot) { return static_cast<std::int32_t>(slot + 1); }

std::string body_name(std::size_t slot) { return "Body" + std::to_string(slot); }

void add_vector(Bytes& out, const Eigen::Vector3d& v) {
  for (const double c : {v.x(), v.y(), v.z()}) append(out, static_cast<float>(c));
}

/// Appends a rigid body, or a bone, of a frame: both have the same layout.
void add_pose(Bytes& out, std::int32_t id, const MotiveBone& pose) {
  const outlet::Axes& axes = outlet::natnet_axes();
  append(out, id);
  add_vector(out, axes.position(pose.position));
  const Eigen::Quaterniond q = axes.quaternion(pose.orientation);
  add_vector(out, q.vec());
  append(out, static_cast<float>(q.w()));
  append(out, 0.0F);  // Mean marker error; there are no markers.
  append(out, pose.tracked ? kTracked : std::int16_t{0});
}

MotiveBone shown(const outlet::TrackerBody& body, JointId id) {
  const outlet::TrackerJoint& own = body[id];
  const outlet::TrackerJoint& at = body[outlet::nearest_tracked(body, id)];
  if (!at.tracked) return {};
  return {at.position, own.orientation, own.tracked};
}

void add_rigid_bodies(Bytes& out, const outlet::TrackerFrame& frame) {
  append(out, static_cast<std::uint32_t>(kJointCount * frame.bodies.size() + frame.props.size()));
  for (const outlet::TrackerBody& body : frame.bodies) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
      add_pose(out, rigid_body_id(body.slot, i), shown(body, static_cast<JointId>(i)));
    }
  }
  for (std::size_t i = 0; i < frame.props.size(); ++i) {
    const outlet::TrackerJoint& pose = frame.props[i].pose;
    add_pose(out, rigid_body_id(frame.slots, i), {pose.position, pose.orientation, pose.tracked});
  }
}

void add_skeletons(Bytes& out, const outlet::TrackerFrame& frame, Coordinates coordinates) {
  Bytes skeletons;
  std::uint32_t count = 0;
  for (const outlet::TrackerBody& body : frame.bodies) {
    const auto skeleton = motive_skeleton(body, coordinates);
    if (!skeleton) continue;
    ++count;
    const std::int32_t id = skeleton_id(body.slot);
    append(skeletons, id);
    append(skeletons, static_cast<std::uint32_t>(kBoneCount));
    std::int32_t bone_id = id << 16;
    for (const MotiveBone& bone : *skeleton) add_pose(skeletons, ++bone_id, bone);
  }
  append(out, count);
  out.insert(out.end(), skeletons.begin(), skeletons.end());
}

void add_times(Bytes& out, const outlet::TrackerFrame& frame, const Times& times) {
  append(out, std::uint32_t{0});  // The SMPTE timecode.
  append(out, std::uint32_t{0});  // Its fraction of a frame.
  append(out, seconds(frame.instant - times.start));
  for (const Timestamp t : {frame.instant, times.received, times.sent}) {
    append(out, static_cast<std::uint64_t>(to_unix_ns(t)));
  }
}

/// Appends the description of a rigid body or a bone: both have the same layout.
void add_description(Bytes& out, const std::string& name, std::int32_t id,
                     const BoneDescription& bone) {
  append_text(out, name);
  append(out, id);
  append(out, bone.parent);
  for (const double c : bone.offset) append(out, static_cast<float>(c));
  append(out, kNone);  // Number of markers.
}

void describe_rigid_bodies(Bytes& out, std::size_t slot) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    append(out, kRigidBody);
    const std::string name = body_name(slot) + "_" + std::string(kJointNames[i]);
    add_description(out, name, rigid_body_id(slot, i), {{}, kNoParent, {}});
  }
}

void describe_skeleton(Bytes& out, std::size_t slot, const BoneOffsets& offsets) {
  append(out, kSkeleton);
  append_text(out, body_name(slot));
  append(out, skeleton_id(slot));
  append(out, static_cast<std::uint32_t>(kBoneCount));
  std::int32_t id = 0;
  for (BoneDescription bone : motive_bones()) {
    bone.offset = offsets[static_cast<std::size_t>(id)];
    add_description(out, body_name(slot) + "_" + std::string(bone.name), ++id, bone);
  }
}

}  // namespace

Bytes encode_frame(const outlet::TrackerFrame& frame, const Models& models, const Times& times,
                   bool models_changed) {
  Bytes out;
  append(out, static_cast<std::uint32_t>(frame.sequence & 0x7FFF'FFFFU));
  append(out, kNone);  // marker sets
  append(out, kNone);  // other markers
  const outlet::TrackerFrame nobody;
  add_rigid_bodies(out, models.rigid_bodies ? frame : nobody);
  add_skeletons(out, models.skeletons ? frame : nobody, models.skeleton_coordinates);
  append(out, kNone);  // labelled markers
  append(out, kNone);  // force plates
  append(out, kNone);  // devices
  add_times(out, frame, times);
  // The flags for recording and replay are never set.
  append(out, models_changed ? kModelsChanged : std::int16_t{0});
  append(out, std::uint32_t{0});
  return message_of(Message::Frame, out);
}

Bytes encode_models(std::size_t slots, const Models& models, const std::vector<BoneOffsets>& bones,
                    const std::vector<std::string>& props) {
  const std::size_t each = (models.rigid_bodies ? kJointCount : 0) + (models.skeletons ? 1 : 0);
  Bytes out;
  const std::size_t things = models.rigid_bodies ? props.size() : 0;
  append(out, static_cast<std::uint32_t>(each * slots + things));
  for (std::size_t slot = 0; slot < slots; ++slot) {
    if (models.rigid_bodies) describe_rigid_bodies(out, slot);
    if (models.skeletons) {
      describe_skeleton(out, slot, slot < bones.size() ? bones[slot] : adult_offsets());
    }
  }
  for (std::size_t i = 0; i < things; ++i) {
    append(out, kRigidBody);
    add_description(out, props[i], rigid_body_id(slots, i), {{}, kNoParent, {}});
  }
  return message_of(Message::Models, out);
}

}  // namespace chorus::natnet
