#include "fusion-server/osc/vrchat_encoder.h"

#include <algorithm>
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

std::vector<char> message(std::string_view tracker, std::string_view what,
                          const Eigen::Vector3d& value) {
  std::string address = "/tracking/trackers/";
  address.append(tracker).append("/").append(what);
  return osc::Message(address).vector(value).bytes();
}

Eigen::Vector3d euler_degrees(const Eigen::Quaterniond& world_from_bone) {
  return outlet::unity_angles(outlet::unity_axes().rotation(world_from_bone)).unaryExpr(&to_deg);
}

void add(std::vector<std::vector<char>>& out, std::string_view tracker, const Eigen::Vector3d& at,
         const Eigen::Quaterniond& world_from_tracker) {
  out.push_back(message(tracker, "position", outlet::unity_axes().position(at)));
  out.push_back(message(tracker, "rotation", euler_degrees(world_from_tracker)));
}

/// The thing that has this tracker's number; null if the body has it.
const PropTracker* thing_of(const Content& content, std::string_view tracker) {
  for (const PropTracker& each : content.trackers)
    if (std::to_string(each.tracker) == tracker) return &each;
  return nullptr;
}

}  // namespace

std::vector<std::vector<char>> encode(const outlet::TrackerBody& body, const Content& content) {
  const outlet::Humanoid rig = outlet::humanoid_of(body);
  std::vector<std::vector<char>> out;
  for (const Worn& worn : kTrackers) {
    if (thing_of(content, worn.name) != nullptr) continue;
    if (!body[worn.place].tracked || !rig[worn.turns].known) continue;
    if (worn.name == kHead && !content.head) continue;
    add(out, worn.name, body[worn.place].position, rig[worn.turns].world_from_bone);
  }
  for (const PropTracker& each : content.trackers) {
    const auto held = std::ranges::find(content.props, each.prop, &outlet::TrackerProp::name);
    if (held == content.props.end()) continue;
    add(out, std::to_string(each.tracker), (*held)->pose.position, (*held)->pose.orientation);
  }
  return out;
}

}  // namespace chorus::vrchat
