#include "fusion-server/publish/vmc/vmc_encoder.h"

#include <array>
#include <string_view>

#include "fusion-server/publish/axes.h"
#include "fusion-server/publish/humanoid.h"
#include "fusion-server/publish/osc/osc.h"

namespace chorus::publish::vmc {
namespace {

constexpr std::int32_t kLoaded = 1;
constexpr std::int32_t kCalibrated = 3;
constexpr std::int32_t kNormalMode = 0;

/// The points that full-body trackers are worn at.
constexpr std::array kWorn{
    HumanBone::Head,          HumanBone::Chest,    HumanBone::Hips,      HumanBone::LeftLowerArm,
    HumanBone::RightLowerArm, HumanBone::LeftHand, HumanBone::RightHand, HumanBone::LeftLowerLeg,
    HumanBone::RightLowerLeg, HumanBone::LeftFoot, HumanBone::RightFoot,
};

std::string_view name_of(HumanBone bone) { return kHumanBoneNames[static_cast<std::size_t>(bone)]; }

osc::Message pose(std::string_view address, std::string_view name, const BonePose& in_parent) {
  osc::Message message(address);
  message.text(name)
      .vector(unity_axes().position(in_parent.origin))
      .quaternion(unity_axes().quaternion(in_parent.world_from_bone));
  return message;
}

BonePose local(const Humanoid& rig, HumanBone bone) {
  return bone == HumanBone::Hips ? rig[bone] : relative_to(rig[parent_of(bone)], rig[bone]);
}

void add_bones(osc::Bundles& out, const Humanoid& rig) {
  for (std::size_t i = 0; i < kHumanBoneCount; ++i) {
    const auto bone = static_cast<HumanBone>(i);
    if (rig[bone].known) out.add(pose("/VMC/Ext/Bone/Pos", name_of(bone), local(rig, bone)));
  }
}

void add_trackers(osc::Bundles& out, const Humanoid& rig) {
  for (const HumanBone bone : kWorn) {
    if (rig[bone].known) out.add(pose("/VMC/Ext/Tra/Pos", name_of(bone), rig[bone]));
  }
}

}  // namespace

std::vector<std::vector<char>> encode(const TrackerBody* body, const Content& content) {
  const Humanoid rig = body ? humanoid_of(*body) : Humanoid{};
  const bool tracked = rig[HumanBone::Hips].known;
  osc::Bundles out;
  osc::Message ok("/VMC/Ext/OK");
  out.add(ok.integer(kLoaded).integer(kCalibrated).integer(kNormalMode).integer(tracked ? 1 : 0));
  out.add(osc::Message("/VMC/Ext/T").real(content.seconds));
  if (tracked) {
    out.add(pose("/VMC/Ext/Root/Pos", "root", BonePose{}));
    add_bones(out, rig);
    if (content.trackers) add_trackers(out, rig);
  }
  return out.all();
}

}  // namespace chorus::publish::vmc
