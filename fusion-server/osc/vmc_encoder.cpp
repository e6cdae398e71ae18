#include "fusion-server/osc/vmc_encoder.h"

#include <array>
#include <string_view>

#include "fusion-server/osc/osc.h"
#include "fusion-server/outlet/axes.h"
#include "fusion-server/outlet/humanoid.h"

namespace chorus::vmc {
namespace {

constexpr std::int32_t kLoaded = 1;
constexpr std::int32_t kCalibrated = 3;
constexpr std::int32_t kNormalMode = 0;

/// The bones at which full-body trackers are worn.
constexpr std::array kWorn{
    outlet::HumanBone::Head,          outlet::HumanBone::Chest,
    outlet::HumanBone::Hips,          outlet::HumanBone::LeftLowerArm,
    outlet::HumanBone::RightLowerArm, outlet::HumanBone::LeftHand,
    outlet::HumanBone::RightHand,     outlet::HumanBone::LeftLowerLeg,
    outlet::HumanBone::RightLowerLeg, outlet::HumanBone::LeftFoot,
    outlet::HumanBone::RightFoot,
};

std::string_view name_of(outlet::HumanBone bone) {
  return outlet::kHumanBoneNames[static_cast<std::size_t>(bone)];
}

osc::Message pose(std::string_view address, std::string_view name,
                  const outlet::BonePose& in_parent) {
  osc::Message message(address);
  message.text(name)
      .vector(outlet::unity_axes().position(in_parent.origin))
      .quaternion(outlet::unity_axes().quaternion(in_parent.world_from_bone));
  return message;
}

outlet::BonePose local(const outlet::Humanoid& rig, outlet::HumanBone bone) {
  return bone == outlet::HumanBone::Hips
             ? rig[bone]
             : outlet::relative_to(rig[outlet::parent_of(bone)], rig[bone]);
}

void add_bones(osc::Bundles& out, const outlet::Humanoid& rig) {
  for (std::size_t i = 0; i < outlet::kHumanBoneCount; ++i) {
    const auto bone = static_cast<outlet::HumanBone>(i);
    if (rig[bone].known) out.add(pose("/VMC/Ext/Bone/Pos", name_of(bone), local(rig, bone)));
  }
}

void add_trackers(osc::Bundles& out, const outlet::Humanoid& rig) {
  for (const outlet::HumanBone bone : kWorn) {
    if (rig[bone].known) out.add(pose("/VMC/Ext/Tra/Pos", name_of(bone), rig[bone]));
  }
}

}  // namespace

std::vector<std::vector<char>> encode(const outlet::TrackerBody* body, const Content& content) {
  const outlet::Humanoid rig = body ? outlet::humanoid_of(*body) : outlet::Humanoid{};
  const bool tracked = rig[outlet::HumanBone::Hips].known;
  osc::Bundles out;
  osc::Message ok("/VMC/Ext/OK");
  out.add(ok.integer(kLoaded).integer(kCalibrated).integer(kNormalMode).integer(tracked ? 1 : 0));
  out.add(osc::Message("/VMC/Ext/T").real(content.seconds));
  if (tracked) {
    out.add(pose("/VMC/Ext/Root/Pos", "root", outlet::BonePose{}));
    add_bones(out, rig);
    if (content.trackers) add_trackers(out, rig);
    for (const outlet::TrackerProp* prop : content.props)
      out.add(pose("/VMC/Ext/Tra/Pos", prop->name,
                   {prop->pose.position, prop->pose.orientation, true}));
  }
  return out.all();
}

std::vector<std::vector<char>> encode_end() {
  osc::Bundles out;
  osc::Message ok("/VMC/Ext/OK");
  out.add(ok.integer(0).integer(0).integer(kNormalMode).integer(0));
  return out.all();
}

}  // namespace chorus::vmc
