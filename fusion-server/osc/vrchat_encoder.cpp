#include "fusion-server/osc/vrchat_encoder.h"

#include <array>
#include <string>
#include <string_view>

#include "common/base/units.h"
#include "fusion-server/osc/osc.h"
#include "fusion-server/outlet/axes.h"
#include "fusion-server/outlet/humanoid.h"

namespace chorus::vrchat {
namespace {

using enum outlet::HumanBone;

struct Worn {
  std::string_view name;
  JointId place;            ///< Gives the position.
  outlet::HumanBone turns;  ///< Gives the rotation.
};

/// VRChat expects the head's position at the base of the head, not at the eyes.
constexpr std::string_view kHead = "head";

constexpr std::array<Worn, 9> kTrackers{{
    {"1", JointId::SpineBase, Hips},
    {"2", JointId::AnkleLeft, LeftFoot},
    {"3", JointId::AnkleRight, RightFoot},
    {"4", JointId::KneeLeft, LeftUpperLeg},
    {"5", JointId::KneeRight, RightUpperLeg},
    {"6", JointId::SpineMid, Chest},
    {"7", JointId::ElbowLeft, LeftUpperArm},
    {"8", JointId::ElbowRight, RightUpperArm},
    {kHead, JointId::Neck, Head},
}};

std::vector<char> message(const Worn& worn, std::string_view what, const Eigen::Vector3d& value) {
  std::string address = "/tracking/trackers/";
  address.append(worn.name).append("/").append(what);
  return osc::Message(address).vector(value).bytes();
}

Eigen::Vector3d euler_degrees(const Eigen::Quaterniond& world_from_bone) {
  return outlet::unity_angles(outlet::unity_axes().rotation(world_from_bone)).unaryExpr(&to_deg);
}

}  // namespace

std::vector<std::vector<char>> encode(const outlet::TrackerBody& body, const Content& content) {
  const outlet::Humanoid rig = outlet::humanoid_of(body);
  std::vector<std::vector<char>> out;
  for (const Worn& worn : kTrackers) {
    if (!body[worn.place].tracked || !rig[worn.turns].known) continue;
    if (worn.name == kHead && !content.head) continue;
    out.push_back(
        message(worn, "position", outlet::unity_axes().position(body[worn.place].position)));
    out.push_back(message(worn, "rotation", euler_degrees(rig[worn.turns].world_from_bone)));
  }
  return out;
}

}  // namespace chorus::vrchat
