#include "fusion-server/trackd/trackd_encoder.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "common/base/units.h"
#include "fusion-server/outlet/axes.h"

namespace chorus::trackd {
namespace {

constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderTime = 16;
constexpr std::size_t kPoseBytes = 24;
/// Offset of the field `calibrated`, after the pose and its time.
constexpr std::size_t kCalibrated = 32;
constexpr std::size_t kControllerBytes = 32;

constexpr std::array kFirst{JointId::Head, JointId::HandRight, JointId::HandLeft};

constexpr std::array<std::size_t, kJointCount> sensors_of_joints() {
  std::array<std::size_t, kJointCount> table{};
  std::size_t next = kFirst.size();
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto found = std::find(kFirst.begin(), kFirst.end(), static_cast<JointId>(i));
    table[i] = found == kFirst.end() ? next++ : static_cast<std::size_t>(found - kFirst.begin());
  }
  return table;
}
constexpr auto kSensorOf = sensors_of_joints();

template <class Value, std::size_t kCount>
void put(std::span<char> block, std::size_t at, const std::array<Value, kCount>& values) {
  std::memcpy(block.data() + at, values.data(), sizeof values);
}

std::array<std::uint32_t, 2> seconds_and_microseconds(Timestamp instant) {
  const auto us = static_cast<std::uint64_t>(to_unix_ns(instant)) / 1000U;
  return {static_cast<std::uint32_t>(us / 1'000'000U), static_cast<std::uint32_t>(us % 1'000'000U)};
}

std::array<float, 6> pose_of(const outlet::TrackerJoint& joint, LengthUnit unit) {
  const outlet::Axes& axes = outlet::trackd_axes();
  Eigen::Vector3d p = axes.position(joint.position);
  if (unit == LengthUnit::Metres) p /= axes.units_per_metre;
  const Eigen::Vector3d a =
      outlet::trackd_angles(axes.rotation(joint.orientation)).unaryExpr(&to_deg);
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()),
          static_cast<float>(a.x()), static_cast<float>(a.y()), static_cast<float>(a.z())};
}

std::size_t sensors_in(std::span<const char> block) {
  return block.size() < kHeaderBytes ? 0 : (block.size() - kHeaderBytes) / kSensorBytes;
}

}  // namespace

std::size_t sensor_of(JointId joint) { return kSensorOf[index_of(joint)]; }

std::vector<char> tracker_block(std::size_t sensors) {
  std::vector<char> block(kHeaderBytes + sensors * kSensorBytes);
  put(block, 0,
      std::array{kVersion, static_cast<std::uint32_t>(sensors),
                 static_cast<std::uint32_t>(kHeaderBytes),
                 static_cast<std::uint32_t>(kSensorBytes)});
  return block;
}

std::vector<char> controller_block() {
  constexpr std::size_t kButtonBytes = kButtons * sizeof(std::int32_t);
  std::vector<char> block(kControllerBytes + kButtonBytes + kValuators * sizeof(float));
  put(block, 0,
      std::array{kVersion, static_cast<std::uint32_t>(kControllerBytes),
                 static_cast<std::uint32_t>(kControllerBytes + kButtonBytes),
                 static_cast<std::uint32_t>(kButtons), static_cast<std::uint32_t>(kValuators)});
  return block;
}

void write_sensors(const outlet::TrackerFrame& frame, LengthUnit unit, std::span<char> block,
                   std::size_t things) {
  // Readers may read at any time, so the "calibrated" flag of a tracked sensor must not be cleared
  // even for a moment.
  std::vector<bool> tracked(sensors_in(block));
  const std::size_t bodies = tracked.size() - std::min(things, tracked.size());
  const auto number = static_cast<std::int32_t>(frame.sequence & 0x7FFF'FFFFU);
  const auto write = [&](std::size_t sensor, const outlet::TrackerJoint& pose) {
    const std::size_t at = kHeaderBytes + sensor * kSensorBytes;
    put(block, at, pose_of(pose, unit));
    put(block, at + kPoseBytes, seconds_and_microseconds(frame.instant));
    put(block, at + kCalibrated, std::array{std::int32_t{1}, number});
    tracked[sensor] = true;
  };
  for (const outlet::TrackerBody& body : frame.bodies)
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const std::size_t sensor = kJointCount * body.slot + kSensorOf[i];
      if (body.joints[i].tracked && sensor < bodies) write(sensor, body.joints[i]);
    }
  for (std::size_t i = 0; i < frame.props.size() && bodies + i < tracked.size(); ++i)
    if (frame.props[i].pose.tracked) write(bodies + i, frame.props[i].pose);
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    if (tracked[i]) continue;
    put(block, kHeaderBytes + i * kSensorBytes + kCalibrated, std::array{std::int32_t{0}});
  }
}

void write_stamp(Timestamp instant, std::span<char> block) {
  if (block.size() >= kHeaderBytes) put(block, kHeaderTime, seconds_and_microseconds(instant));
}

}  // namespace chorus::trackd
