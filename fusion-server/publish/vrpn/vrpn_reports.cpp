#include "fusion-server/publish/vrpn/vrpn_reports.h"

#include <algorithm>
#include <array>

#include "common/base/duration.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "fusion-server/publish/axes.h"
#include "fusion-server/publish/vrpn/vrpn_codec.h"

namespace chorus::publish::vrpn {
namespace {

/// In the order of ReportType.
constexpr std::array<std::string_view, 3> kTypeNames{
    "vrpn_Base pong_message", "vrpn_Tracker Pos_Quat", "vrpn_Tracker Velocity"};

/// A velocity's rotation is the turn within this time; short, so that no turn is ambiguous.
constexpr Duration kTurnTime = std::chrono::milliseconds(10);

Payload sensor(std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  Payload payload;
  payload.integer(value).integer(value);  // the second is padding, in which VRPN repeats the sensor
  return payload;
}

void add_vectors(Payload& out, const Eigen::Vector3d& v, const Eigen::Quaterniond& q) {
  for (const double value : {v.x(), v.y(), v.z(), q.x(), q.y(), q.z(), q.w()}) out.real(value);
}

/// Where a joint's reports go: to which tracker, as which sensor.
struct Address {
  std::size_t tracker = 0;
  std::size_t sensor = 0;
};

void add(Reports& out, const MessageHead& head, const Payload& payload) {
  const std::size_t begin = out.bytes.size();
  append_message(out.bytes, head, payload.bytes());
  out.messages.push_back({static_cast<std::size_t>(head.sender), begin, out.bytes.size() - begin});
}

void add_joint(Reports& out, Timestamp time, const Address& to, const TrackerJoint& joint) {
  MessageHead head{time, static_cast<std::int32_t>(to.tracker),
                   static_cast<std::int32_t>(ReportType::PosQuat), 0};
  Payload pose = sensor(to.sensor);
  add_vectors(pose, vrpn_axes().position(joint.position),
              vrpn_axes().quaternion(joint.orientation));
  add(out, head, pose);
  head.type = static_cast<std::int32_t>(ReportType::Velocity);
  const Eigen::Quaterniond turn = exp_map(seconds(kTurnTime) * joint.angular_velocity);
  Payload velocity = sensor(to.sensor);
  add_vectors(velocity, vrpn_axes().position(joint.velocity), vrpn_axes().quaternion(turn));
  velocity.real(seconds(kTurnTime));
  add(out, head, velocity);
}

}  // namespace

Trackers::Trackers(std::size_t slots, bool each_joint) : slots_(slots), each_joint_(each_joint) {
  for (std::size_t slot = 0; slot < slots; ++slot) names_.push_back("Body" + std::to_string(slot));
  for (std::size_t slot = 0; each_joint && slot < slots; ++slot) {
    for (const std::string_view joint : kJointNames) {
      names_.push_back(names_[slot] + "_" + std::string(joint));
    }
  }
}

std::optional<std::size_t> Trackers::index_of(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

std::optional<std::size_t> Trackers::joint(std::size_t slot, std::size_t joint) const {
  if (!each_joint_) return std::nullopt;
  return slots_ + slot * kJointCount + joint;
}

std::string Trackers::descriptions() const {
  std::string out;
  std::int32_t id = 0;
  for (const std::string& name : names_) append_description(out, SystemType::Sender, id++, name);
  id = 0;
  for (const std::string_view name : kTypeNames) {
    append_description(out, SystemType::Type, id++, name);
  }
  return out;
}

Reports encode(const TrackerFrame& frame, const Trackers& trackers) {
  Reports out;
  for (const TrackerBody& body : frame.bodies) {
    for (const bool alone : {false, true}) {  // the body's tracker first, then those of its joints
      for (std::size_t i = 0; i < kJointCount; ++i) {
        const auto own = trackers.joint(body.slot, i);
        if (!body.joints[i].tracked || (alone && !own)) continue;
        const Address to = alone ? Address{*own, 0} : Address{trackers.body(body.slot), i};
        add_joint(out, frame.instant, to, body.joints[i]);
      }
    }
  }
  return out;
}

}  // namespace chorus::publish::vrpn
