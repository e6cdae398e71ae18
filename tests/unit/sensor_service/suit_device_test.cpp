// The device `suit`: frames from poses, and the network stream over loopback.
#include <chrono>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "common/hand/hand_json.h"
#include "common/net/asio.h"
#include "common/suit/mxtp_datagram.h"
#include "services/sensor/device/suit/served_suit.h"
#include "services/sensor/device/suit/suit_clock.h"
#include "services/sensor/device/suit/suit_frames.h"
#include "services/sensor/device/suit/suit_gloves.h"
#include "services/sensor/device/suit/suit_receiver.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/suit/mxtp_bytes.h"

namespace chorus::suit {
namespace {

using chorus::testing::IsOk;
using chorus::testing::kStart;

TEST(SuitClock, TheLeastDelayTellsTheOffset) {
  SuitClock clock(std::chrono::milliseconds(20));
  using std::chrono::milliseconds;
  (void)clock.captured(milliseconds(1000), kStart + milliseconds(35));
  (void)clock.captured(milliseconds(1010), kStart + milliseconds(10 + 20));  // the quickest
  const Timestamp late = clock.captured(milliseconds(1020), kStart + milliseconds(20 + 60));
  EXPECT_NEAR(seconds(late - kStart), 0.020, 0.001);
}

TEST(SuitClock, BeginsAnewWithTheMeasurement) {
  SuitClock clock(Duration{0});
  (void)clock.captured(std::chrono::seconds(500), kStart);
  const Timestamp anew = clock.captured(Duration{0}, kStart + std::chrono::seconds(1));
  EXPECT_EQ(anew, kStart + std::chrono::seconds(1));
}

TEST(ServedSuit, TakesTheFloorsNormalForUp) {
  // A camera that looks down by 20 degrees serves somebody who stands upright.
  const Eigen::AngleAxisd tilt(0.35, Eigen::Vector3d::UnitX());
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.linear() = tilt.toRotationMatrix();
  SensorFrame frame;
  frame.captured = kStart;
  frame.floor = FloorPlane{tilt * Eigen::Vector3d::UnitY(), 0.0};
  const auto body = chorus::testing::standing_person();
  frame.bodies.push_back({BodyId{1}, kStart, to_sensor(turned, body)});
  const SuitInstant instant = instant_of(frame, frame.bodies.front());
  const SuitPose truth = pose_of(body, Duration{0});
  EXPECT_THAT(instant.pose.joints[JointId::Head].position,
              chorus::testing::VectorNear(truth.joints[JointId::Head].position, 1e-9));
  EXPECT_EQ(instant.captured, kStart);
}

TEST(ServedSuit, HasNoPoseInRays) {
  SensorFrame frame;
  frame.bodies.push_back(
      {BodyId{1}, kStart,
       to_sensor(Eigen::Isometry3d::Identity(), chorus::testing::standing_person())});
  for (Joint& joint : frame.bodies.front().skeleton.joints) joint.measurement = Measurement::Ray;
  EXPECT_FALSE(instant_of(frame, frame.bodies.front()).pose.joints[JointId::SpineBase].seen());
}

SuitInstant standing(double at_s) {
  return {pose_of(chorus::testing::standing_person(), from_seconds(at_s)),
          {5, 1, 5},
          kStart + from_seconds(at_s)};
}

TEST(SuitFrames, StandOnTheFloorAtTheBeginningOfTheWalk) {
  SuitFrames frames(chorus::testing::sensor_id("s1"), {});
  const auto frame = frames.next(standing(0.0));
  ASSERT_TRUE(frame && frame->bodies.size() == 1 && frame->floor);
  const auto& body = frame->bodies.front().skeleton;
  EXPECT_NEAR(body[JointId::SpineBase].position.x(), 0.0, 1e-9);
  EXPECT_LT(std::abs(body[JointId::FootLeft].position.y()), 0.06);
  EXPECT_TRUE(body[JointId::SpineBase].covariance.known());
}

TEST(SuitFrames, TakeTheSuitsOwnPlaceIfAskedTo) {
  SuitSettings settings;
  settings.walk = false;
  SuitFrames frames(chorus::testing::sensor_id("s1"), settings);
  const auto frame = frames.next(standing(0.0));
  ASSERT_TRUE(frame && !frame->bodies.empty());
  EXPECT_THAT(frame->bodies.front().skeleton[JointId::SpineBase].position,
              chorus::testing::VectorNear(Eigen::Vector3d(5, 1, 5), 1e-9));
}

/// Files of a straight right hand that points along +z, as `chorus scan` and a glove's program
/// write them.
struct GloveFolder {
  chorus::testing::TemporaryFolder folder;

  std::string put(const std::string& name, const std::string& text) const {
    const std::string file = (folder.path() / name).string();
    std::ofstream(file) << text;
    return file;
  }
  [[nodiscard]] GloveFiles files() const {
    hand::Skeleton skeleton;
    skeleton.palm_radius = 0.04;
    skeleton.palm = {0.0, 0.05, 0.0};
    skeleton.widths.fill(0.016);
    for (std::size_t f = 0; f < hand::kFingers; ++f)
      for (std::size_t i = 0; i < hand::kFingerJoints; ++i)
        skeleton.joints[hand::hand_joint(f, i)] = {0.02 * (2.0 - static_cast<double>(f)),
                                                   0.08 + 0.03 * static_cast<double>(i), 0.0};
    hand::Pose pose;
    pose.turn = Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitX());
    return {put("hand.json", hand::scan_json({}, skeleton, {})),
            put("take.bvh", hand::bvh_of(skeleton, std::vector{pose}, 30.0))};
  }
};

TEST(SuitGloves, AreHandsOnTheSuitsWrists) {
  const GloveFolder folder;
  SuitSettings settings;
  settings.gloves = {folder.files()};
  auto gloves = SuitGloves::open(settings);
  ASSERT_THAT(gloves, IsOk());
  SuitFrames frames(chorus::testing::sensor_id("s1"), settings);
  const SuitInstant instant = standing(0.0);
  auto body = frames.next(instant)->bodies.front();
  body.hands = gloves->hands(instant, 0.0, body.skeleton);
  ASSERT_TRUE(body.hands && body.hands->right);
  EXPECT_FALSE(body.hands->left);
  const Joint& wrist = body.skeleton[JointId::WristRight];
  EXPECT_THAT(body.hands->right->wrist(), chorus::testing::VectorNear(wrist.position, 1e-12));
  EXPECT_NEAR(body.hands->right->variance.value(), wrist.covariance.matrix().trace() / 3, 1e-12);
  const Eigen::Vector3d tip = body.hands->right->points[hand::hand_joint(2, 3)];
  EXPECT_NEAR((tip - wrist.position).norm(), 0.17, 0.001);
  body.skeleton[JointId::ElbowRight] = {};
  EXPECT_FALSE(gloves->hands(instant, 0.0, body.skeleton)) << "no forearm";
}

TEST(SuitGloves, ThatCannotBeReadAreRefusedByName) {
  const GloveFolder folder;
  const auto error = [](const GloveFiles& files, int times = 1) {
    SuitSettings settings;
    settings.gloves.assign(static_cast<std::size_t>(times), files);
    const auto gloves = SuitGloves::open(settings);
    return gloves ? "opened" : to_string(gloves.error());
  };
  const GloveFiles good = folder.files();
  EXPECT_EQ(error(good), "opened");
  EXPECT_NE(error(good, 2).find("two right hands"), std::string::npos);
  EXPECT_NE(error({good.hand, ""}).find("gloves.take"), std::string::npos);
  EXPECT_NE(error({"no.json", good.take}).find("gloves.hand"), std::string::npos);
  EXPECT_NE(error({good.hand, good.hand}).find("gloves.take"), std::string::npos);
}

TEST(SuitFrames, AreScaledToTheStature) {
  SuitSettings settings;
  settings.stature = 1.40;
  SuitFrames small(chorus::testing::sensor_id("s1"), settings);
  SuitFrames own(chorus::testing::sensor_id("s1"), {});
  const auto height = [](SuitFrames& frames) {
    return frames.next(standing(0.0))->bodies.front().skeleton[JointId::Head].position.y();
  };
  const double full = stature_of(standing(0.0).pose);
  EXPECT_NEAR(height(small) / height(own), 1.40 / full, 0.02);
}

TEST(SuitFrames, ComeNoFasterThanAsked) {
  SuitSettings settings;
  settings.max_rate_hz = 30.0;
  SuitFrames frames(chorus::testing::sensor_id("s1"), settings);
  int count = 0;
  for (int i = 0; i < 240; ++i) count += frames.next(standing(i / 240.0)) ? 1 : 0;
  EXPECT_NEAR(count, 30, 4);
}

/// Receives until `wanted` datagrams have come, or for five seconds.
int received(const SuitSettings& settings, int wanted,
             const std::function<void(std::uint16_t port)>& send) {
  std::stop_source stop;
  int count = 0;
  auto receiver = SuitReceiver::open(settings, [&](std::span<const char> bytes) {
    count += read_mxtp(bytes) ? 1 : 0;
    if (count == wanted) stop.request_stop();
  });
  EXPECT_THAT(receiver, IsOk());
  if (!receiver) return -1;
  std::jthread sender([&] { send((*receiver)->port()); });
  std::jthread limit([&](const std::stop_token& over) {
    for (int i = 0; i < 500 && !over.stop_requested() && !stop.stop_requested(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    stop.request_stop();
  });
  (*receiver)->run(stop.get_token());
  return count;
}

TEST(SuitReceiver, HearsDatagrams) {
  SuitSettings settings;
  settings.port = 0;
  const int count = received(settings, 3, [](std::uint16_t port) {
    asio::io_context io;
    net::DatagramSocket socket(io.get_executor(), net::udp::endpoint(net::udp::v4(), 0));
    const net::udp::endpoint to(asio::ip::address_v4::loopback(), port);
    for (std::uint32_t sample = 1; sample <= 3; ++sample) {
      const auto bytes = testing::datagram({.sample = sample}, testing::quaternion_items());
      socket.send_to(asio::buffer(bytes), to);
    }
  });
  EXPECT_EQ(count, 3);
}

TEST(SuitReceiver, HearsAStream) {
  SuitSettings settings;
  settings.port = 0;
  settings.transport = Transport::Tcp;
  const int count = received(settings, 5, [](std::uint16_t port) {
    asio::io_context io;
    net::Socket socket(io.get_executor());
    socket.connect({asio::ip::address_v4::loopback(), port});
    for (std::uint32_t sample = 1; sample <= 5; ++sample) {
      const auto bytes = testing::datagram({.sample = sample}, testing::quaternion_items());
      asio::write(socket, asio::buffer(bytes));
    }
  });
  EXPECT_EQ(count, 5);
}

TEST(SuitReceiver, NamesTheKeyOfAPortThatIsTaken) {
  SuitSettings settings;
  settings.port = 0;
  const auto first = SuitReceiver::open(settings, [](std::span<const char>) {});
  ASSERT_THAT(first, IsOk());
  settings.port = (*first)->port();
  const auto second = SuitReceiver::open(settings, [](std::span<const char>) {});
  ASSERT_FALSE(second);
  EXPECT_NE(to_string(second.error()).find("device.suit.port"), std::string::npos);
}

}  // namespace
}  // namespace chorus::suit
