#include "fusion-server/dtrack/dtrack_encoder.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <string_view>

#include "common/base/units.h"
#include "fusion-server/outlet/axes.h"
#include "fusion-server/outlet/humanoid.h"

namespace chorus::dtrack {
namespace {

constexpr std::string_view kEnd = "\r\n";
constexpr std::string_view kSeen = " 1.000]";  ///< The quality.
constexpr int kPlaceDigits = 3;
constexpr int kAngleDigits = 4;
constexpr int kMatrixDigits = 6;
constexpr auto kDay = std::chrono::hours(24);

using enum outlet::HumanBone;

struct HumanJoint {
  std::size_t id;
  outlet::HumanBone bone;
};

/// A.R.T.'s numbers of the joints; number 2 (spine_02) is a vertebra for which we have no bone.
constexpr std::array<HumanJoint, 20> kHumanJoints{{
    {0, Hips},           {1, Spine},          {3, Chest},          {4, UpperChest},
    {5, Neck},           {6, Head},           {7, LeftShoulder},   {8, LeftUpperArm},
    {9, LeftLowerArm},   {10, LeftHand},      {11, RightShoulder}, {12, RightUpperArm},
    {13, RightLowerArm}, {14, RightHand},     {15, LeftUpperLeg},  {16, LeftLowerLeg},
    {17, LeftFoot},      {18, RightUpperLeg}, {19, RightLowerLeg}, {20, RightFoot},
}};

void add(std::string& out, std::uint64_t value) {
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

/// Appends a number in fixed point; coordinates are bounded (kMaxCoordinate), so it has few digits.
void add(std::string& out, double value, int digits) {
  if (std::abs(value) < 0.5 * std::pow(10.0, -digits)) value = 0.0;  // Avoids "-0.000".
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, digits);
  out.append(text.data(), end.ec == std::errc{} ? end.ptr : text.data());
}

void add_all(std::string& out, const Eigen::Vector3d& values, int digits) {
  for (const double value : values) {
    if (out.back() != '[') out += ' ';
    add(out, value, digits);
  }
}

/// Appends [sx sy sz eta theta phi][b0 .. b8].
void add_pose(std::string& out, const outlet::Axes& axes, const Eigen::Vector3d& x_in_world,
              const Eigen::Quaterniond& world_from_body) {
  const Eigen::Matrix3d r = axes.rotation(world_from_body);
  out += '[';
  add_all(out, axes.position(x_in_world), kPlaceDigits);
  add_all(out, outlet::dtrack_angles(r).unaryExpr(&to_deg), kAngleDigits);
  out += "][";
  for (const Eigen::Index column : {0, 1, 2}) add_all(out, r.col(column), kMatrixDigits);
  out += ']';
}

void add_times(std::string& out, Timestamp instant, Duration latency) {
  using std::chrono::duration_cast;
  using std::chrono::microseconds;
  const auto since_epoch = duration_cast<microseconds>(instant.time_since_epoch());
  const auto seconds_and_rest = [&out](microseconds time, std::string_view between, auto pad) {
    add(out, static_cast<std::uint64_t>(time / std::chrono::seconds(1)));
    out += between;
    const auto rest = std::to_string((time % std::chrono::seconds(1)).count());
    if (pad) out.append(6 - rest.size(), '0');
    out += rest;
  };
  out += "ts ";
  seconds_and_rest(since_epoch % kDay, ".", true);
  out.append(kEnd).append("ts2 ");
  seconds_and_rest(since_epoch, " ", false);
  out += ' ';
  const auto late = std::max(duration_cast<microseconds>(latency), microseconds(0));
  add(out, static_cast<std::uint64_t>(late.count()));
  out += kEnd;
}

void add_line(std::string& out, std::string_view name, std::uint64_t count, std::string_view rest) {
  out.append(name).append(" ");
  add(out, count);
  out.append(rest).append(kEnd);
}

std::size_t add_bodies(std::string& out, const outlet::Axes& axes,
                       const outlet::TrackerBody& body) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const std::size_t id = kJointCount * body.slot + i;
    if (!body.joints[i].tracked || id >= kMaxDtrackBodies) continue;
    out += " [";
    add(out, id);
    out += kSeen;
    add_pose(out, axes, body.joints[i].position, body.joints[i].orientation);
    ++count;
  }
  return count;
}

std::size_t people_ids(const outlet::TrackerFrame& frame) {
  return std::min(kJointCount * frame.slots, kMaxDtrackBodies);
}

/// Things in hands; what does not fit into a datagram is left out.
std::size_t add_props(std::string& out, const outlet::Axes& axes,
                      const outlet::TrackerFrame& frame) {
  constexpr std::size_t kRest = 256;  // fr, ts, ts2, 6dcal, 6d and 3d, without the bodies
  std::size_t count = 0;
  for (std::size_t i = 0; i < frame.props.size(); ++i) {
    const outlet::TrackerJoint& pose = frame.props[i].pose;
    if (!pose.tracked) continue;
    std::string body = " [";
    add(body, people_ids(frame) + i);
    body += kSeen;
    add_pose(body, axes, pose.position, pose.orientation);
    if (out.size() + body.size() + kRest > kMaxBytes) break;
    out += body;
    ++count;
  }
  return count;
}

/// The text " [slot joints][joint 1.000][..][..] ..."; "" when the body's rig is unknown.
std::string human_model(const outlet::Axes& axes, const outlet::TrackerBody& body) {
  const outlet::Humanoid rig = outlet::humanoid_of(body);
  std::string joints;
  std::size_t count = 0;
  for (const HumanJoint& joint : kHumanJoints) {
    const outlet::BonePose& bone = rig[joint.bone];
    if (!bone.known) continue;
    joints += '[';
    add(joints, joint.id);
    joints += kSeen;
    add_pose(joints, axes, bone.origin, bone.world_from_bone);
    ++count;
  }
  if (count == 0) return {};
  std::string out = " [";
  add(out, body.slot);
  out += ' ';
  add(out, count);
  return out + "]" + joints;
}

void add_human_models(std::string& out, const outlet::Axes& axes,
                      const outlet::TrackerFrame& frame) {
  constexpr std::size_t kHeadOfLine = 32;
  std::string models;
  std::uint64_t count = 0;
  for (const outlet::TrackerBody& body : frame.bodies) {
    const std::string model = human_model(axes, body);
    if (out.size() + kHeadOfLine + models.size() + model.size() > kMaxBytes) break;
    if (model.empty()) continue;
    models += model;
    ++count;
  }
  out += "6dj ";
  add(out, frame.slots);
  add_line(out, "", count, models);
}

}  // namespace

std::string encode(const outlet::TrackerFrame& frame, const Content& content) {
  const outlet::Axes& axes =
      content.room == Room::Normal ? outlet::dtrack_axes() : outlet::dtrack_powerwall_axes();
  std::string bodies;
  std::size_t count = 0;
  for (const outlet::TrackerBody& body : frame.bodies) count += add_bodies(bodies, axes, body);
  count += add_props(bodies, axes, frame);
  std::string out;
  add_line(out, "fr", frame.sequence & 0xFFFF'FFFFU, "");
  add_times(out, frame.instant, content.latency);
  add_line(out, "6dcal", people_ids(frame) + frame.props.size(), "");
  add_line(out, "6d", count, bodies);
  add_line(out, "3d", 0, "");
  if (content.human_model) add_human_models(out, axes, frame);
  return out;
}

}  // namespace chorus::dtrack
