#include "fusion-server/vrpn/vrpn_reports.h"

#include <algorithm>
#include <array>

#include "common/base/duration.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "fusion-server/outlet/axes.h"
#include "fusion-server/vrpn/vrpn_codec.h"

namespace chorus::vrpn {
namespace {

/// VRPN's names of the types, in the order of ReportType.
constexpr std::array<std::string_view, 3> kTypeNames{
    "vrpn_Base pong_message", "vrpn_Tracker Pos_Quat", "vrpn_Tracker Velocity"};

/// A velocity message states the rotation within this time, which is so short that it is never
/// ambiguous.
constexpr Duration kTurnTime = std::chrono::milliseconds(10);

void add_vectors(Payload& out, const Eigen::Vector3d& v, const Eigen::Quaterniond& q) {
  for (const double value : {v.x(), v.y(), v.z(), q.x(), q.y(), q.z(), q.w()}) out.real(value);
}

/// What follows the sensor number in a joint's reports; the body's tracker and the joint's own
/// tracker send the same.
struct JointNumbers {
  Payload pose;
  Payload velocity;
};

JointNumbers numbers_of(const outlet::TrackerJoint& joint) {
  JointNumbers out;
  const outlet::Axes& axes = outlet::vrpn_axes();
  add_vectors(out.pose, axes.position(joint.position), axes.quaternion(joint.orientation));
  const Eigen::Quaterniond turn = exp_map(seconds(kTurnTime) * joint.angular_velocity);
  add_vectors(out.velocity, axes.position(joint.velocity), axes.quaternion(turn));
  out.velocity.real(seconds(kTurnTime));
  return out;
}

/// Where a joint's reports go: to which tracker, as which sensor.
struct Address {
  std::size_t tracker = 0;
  std::size_t sensor = 0;
};

void add(Reports& out, const MessageHead& head, std::size_t sensor, const Payload& numbers) {
  const auto number = static_cast<std::uint32_t>(sensor);
  Payload payload;
  payload.integer(number).integer(number);  // VRPN repeats the sensor as padding.
  const std::size_t begin = out.bytes.size();
  append_message(out.bytes, head, payload.bytes() + numbers.bytes());
  out.messages.push_back({static_cast<std::size_t>(head.sender), begin, out.bytes.size() - begin});
}

void add_joint(Reports& out, Timestamp time, const Address& to, const JointNumbers& numbers) {
  MessageHead head{time, static_cast<std::int32_t>(to.tracker),
                   static_cast<std::int32_t>(ReportType::PosQuat), 0};
  add(out, head, to.sensor, numbers.pose);
  head.type = static_cast<std::int32_t>(ReportType::Velocity);
  add(out, head, to.sensor, numbers.velocity);
}

void add_body(Reports& out, Timestamp time, const outlet::TrackerBody& body,
              const Trackers& trackers) {
  std::array<std::optional<JointNumbers>, kJointCount> joints;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!body.joints[i].tracked) continue;
    joints[i] = numbers_of(body.joints[i]);
    add_joint(out, time, {trackers.body(body.slot), i}, *joints[i]);
  }
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto own = trackers.joint(body.slot, i);
    if (own && joints[i]) add_joint(out, time, {*own, 0}, *joints[i]);
  }
}

}  // namespace

Trackers::Trackers(std::size_t slots, bool each_joint, const std::vector<std::string>& props)
    : slots_(slots), each_joint_(each_joint) {
  for (std::size_t slot = 0; slot < slots; ++slot) names_.push_back("Body" + std::to_string(slot));
  for (std::size_t slot = 0; each_joint && slot < slots; ++slot) {
    for (const std::string_view joint : kJointNames) {
      names_.push_back(names_[slot] + "_" + std::string(joint));
    }
  }
  first_prop_ = names_.size();
  names_.insert(names_.end(), props.begin(), props.end());
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

std::optional<std::size_t> Trackers::prop(std::size_t index) const {
  if (first_prop_ + index >= names_.size()) return std::nullopt;
  return first_prop_ + index;
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

Reports encode(const outlet::TrackerFrame& frame, const Trackers& trackers) {
  Reports out;
  for (const outlet::TrackerBody& body : frame.bodies) add_body(out, frame.instant, body, trackers);
  for (std::size_t i = 0; i < frame.props.size(); ++i) {
    const outlet::TrackerJoint& pose = frame.props[i].pose;
    const auto own = trackers.prop(i);
    if (own && pose.tracked) add_joint(out, frame.instant, {*own, 0}, numbers_of(pose));
  }
  return out;
}

}  // namespace chorus::vrpn
