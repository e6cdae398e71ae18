// trackd's blocks, read at the offsets that other programs' readers use.
#include "fusion-server/trackd/trackd_encoder.h"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <set>
#include <span>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/support/matchers.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::trackd {
namespace {

using chorus::testing::VectorNear;
using outlet::testing::about_up;
using outlet::testing::about_x;
using outlet::testing::about_z;

// The blocks as C programs declare them: no padding anywhere.
struct TrackerHeader {
  std::uint32_t version, sensors, offset, size, seconds, microseconds, command;
};
struct Sensor {
  float x, y, z, azimuth, elevation, roll;
  std::uint32_t seconds, microseconds;
  std::int32_t calibrated, frame;
};
struct ControllerHeader {
  std::uint32_t version, button_offset, valuator_offset, buttons, valuators, seconds, microseconds,
      command;
};
static_assert(sizeof(TrackerHeader) == 28 && sizeof(Sensor) == 40 &&
              sizeof(ControllerHeader) == 32);

template <class T>
T read(const std::vector<char>& block, std::size_t at) {
  T value;
  EXPECT_LE(at + sizeof value, block.size());
  std::memcpy(&value, block.data() + at, sizeof value);
  return value;
}

Sensor sensor(const std::vector<char>& block, std::size_t i) {
  const auto header = read<TrackerHeader>(block, 0);
  return read<Sensor>(block, header.offset + i * header.size);
}

outlet::TrackerFrame frame_with(const outlet::TrackerBody& body, std::size_t slot) {
  outlet::TrackerFrame frame;
  frame.sequence = 0x1'8000'0007;
  frame.instant = from_unix_ns(1'795'246'604'101'847'341);
  frame.bodies = {body};
  frame.bodies[0].slot = slot;
  return frame;
}

outlet::TrackerBody one_joint() {
  outlet::TrackerBody body;
  outlet::TrackerJoint& hand = body.joints[index_of(JointId::HandRight)];
  hand.position = {1, 2, 3};
  hand.orientation = about_up(150) * about_x(40) * about_z(-70);
  hand.tracked = true;
  return body;
}

TEST(Trackd, HeadersSayWhereEverythingIs) {
  const auto tracker = tracker_block(50);
  EXPECT_EQ(tracker.size(), 28u + 50u * 40u);
  const auto header = read<TrackerHeader>(tracker, 0);
  EXPECT_EQ(header.version, 1u);
  EXPECT_EQ(header.sensors, 50u);
  EXPECT_EQ(header.offset, 28u);
  EXPECT_EQ(header.size, 40u);
  EXPECT_EQ(header.command, 0u);
  const auto controller = controller_block();
  const auto c = read<ControllerHeader>(controller, 0);
  EXPECT_EQ(c.version, 1u);
  EXPECT_EQ(c.button_offset, 32u);
  EXPECT_EQ(c.valuator_offset, 32u + 4u * c.buttons);
  EXPECT_EQ(controller.size(), 32u + 4u * (c.buttons + c.valuators));
}

TEST(Trackd, AnAsymmetricPoseIsInFeetAndDegrees) {
  auto block = tracker_block(150);
  write_sensors(frame_with(one_joint(), 2), LengthUnit::Feet, block);
  const Sensor wand = sensor(block, 2 * 25 + 1);
  const Eigen::Vector3d place(static_cast<double>(wand.x), static_cast<double>(wand.y),
                              static_cast<double>(wand.z));
  EXPECT_THAT(place, VectorNear(Eigen::Vector3d(3.28084, 6.56168, 9.84252), 1e-4));
  EXPECT_NEAR(static_cast<double>(wand.azimuth), 150, 1e-3);
  EXPECT_NEAR(static_cast<double>(wand.elevation), 40, 1e-3);
  EXPECT_NEAR(static_cast<double>(wand.roll), -70, 1e-3);
  EXPECT_EQ(wand.calibrated, 1);
  EXPECT_EQ(wand.frame, 7);
  EXPECT_EQ(wand.seconds, 1'795'246'604u);
  EXPECT_EQ(wand.microseconds, 101'847u);
}

TEST(Trackd, ThingsInHandsAreTheLastSensorsAndBodiesDoNotReachThem) {
  auto block = tracker_block(25 + 2);
  outlet::TrackerFrame frame = frame_with(one_joint(), 1);  // the second slot has no sensors here
  frame.props.resize(2);
  frame.props[1].pose = one_joint()[JointId::HandRight];
  write_sensors(frame, LengthUnit::Metres, block, 2);
  EXPECT_EQ(sensor(block, 25).calibrated, 0) << "nobody holds the first thing";
  EXPECT_EQ(sensor(block, 26).calibrated, 1);
  EXPECT_FLOAT_EQ(sensor(block, 26).z, 3.0F);
  write_sensors({}, LengthUnit::Metres, block, 2);
  EXPECT_EQ(sensor(block, 26).calibrated, 0);
}

TEST(Trackd, MetresWhenAsked) {
  auto block = tracker_block(25);
  write_sensors(frame_with(one_joint(), 0), LengthUnit::Metres, block);
  EXPECT_FLOAT_EQ(sensor(block, 1).z, 3.0F);
}

TEST(Trackd, TheHeaderIsStampedAfterwards) {
  auto block = tracker_block(25);
  const outlet::TrackerFrame frame = frame_with(one_joint(), 0);
  write_sensors(frame, LengthUnit::Feet, block);
  EXPECT_EQ(read<TrackerHeader>(block, 0).seconds, 0u);
  write_stamp(frame.instant, block);
  EXPECT_EQ(read<TrackerHeader>(block, 0).seconds, 1'795'246'604u);
  EXPECT_EQ(read<TrackerHeader>(block, 0).microseconds, 101'847u);
}

TEST(Trackd, HeadWandAndLeftHandComeFirstAndEveryJointHasItsSensor) {
  EXPECT_EQ(sensor_of(JointId::Head), 0u);
  EXPECT_EQ(sensor_of(JointId::HandRight), 1u);
  EXPECT_EQ(sensor_of(JointId::HandLeft), 2u);
  std::set<std::size_t> used;
  for (std::size_t i = 0; i < kJointCount; ++i) used.insert(sensor_of(static_cast<JointId>(i)));
  EXPECT_EQ(used.size(), 25u);
  EXPECT_EQ(*used.rbegin(), 24u);
}

TEST(Trackd, WhoIsLostKeepsThePoseAndIsNotCalibrated) {
  auto block = tracker_block(25);
  write_sensors(frame_with(one_joint(), 0), LengthUnit::Feet, block);
  const Sensor before = sensor(block, 1);
  outlet::TrackerFrame nobody = frame_with({}, 0);
  nobody.sequence = 8;
  nobody.bodies[0].joints[index_of(JointId::HandRight)].position.setConstant(std::nan(""));
  write_sensors(nobody, LengthUnit::Feet, block);
  const Sensor after = sensor(block, 1);
  EXPECT_EQ(after.calibrated, 0);
  EXPECT_EQ(after.x, before.x);
  EXPECT_EQ(after.frame, before.frame);
}

/// A block that is read by another process, as by trackd's readers.
struct SharedBlock {
  explicit SharedBlock(const std::vector<char>& content)
      : size(content.size()),
        place(::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    std::memcpy(place, content.data(), size);
  }
  ~SharedBlock() { ::munmap(place, size); }
  [[nodiscard]] std::span<char> bytes() const { return {static_cast<char*>(place), size}; }
  std::size_t size;
  void* place;
};

TEST(Trackd, WhoStaysTrackedIsCalibratedAllTheTime) {
  const SharedBlock block(tracker_block(150));
  outlet::TrackerFrame frame;
  for (std::size_t slot = 0; slot < 6; ++slot) {
    outlet::TrackerBody body;
    for (outlet::TrackerJoint& joint : body.joints) joint.tracked = true;
    body.slot = slot;
    frame.bodies.push_back(body);
  }
  write_sensors(frame, LengthUnit::Feet, block.bytes());
  const pid_t reader = ::fork();
  ASSERT_GE(reader, 0);
  if (reader == 0) {
    const auto* last = reinterpret_cast<const Sensor*>(block.bytes().data() + 28) + 149;
    const volatile std::int32_t& calibrated = last->calibrated;
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
    bool always = true;
    while (std::chrono::steady_clock::now() < until) {
      for (int i = 0; i < 1000; ++i) always = always && calibrated == 1;
    }
    ::_exit(always ? 0 : 1);
  }
  int status = 0;
  while (::waitpid(reader, &status, WNOHANG) == 0)
    write_sensors(frame, LengthUnit::Feet, block.bytes());
  EXPECT_EQ(status, 0);
}

TEST(Trackd, SlotsBeyondTheBlockAreLeftOut) {
  auto block = tracker_block(26);
  const auto before = block;
  // The joint would be sensor 26.
  write_sensors(frame_with(one_joint(), 1), LengthUnit::Feet, block);
  EXPECT_EQ(block, before);
  std::vector<char> tiny(10);
  write_sensors(frame_with(one_joint(), 0), LengthUnit::Feet, tiny);
  write_stamp({}, tiny);
  EXPECT_EQ(tiny, std::vector<char>(10));
}

}  // namespace
}  // namespace chorus::trackd
