// One conversation: what the client receives, what it may request, what ends it.
#include "fusion-server/vrpn/vrpn_conversation.h"

#include <set>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::vrpn {
namespace {

using testing::FailsWith;
using testing::IsOk;
using testing::RotationNear;
using testing::VectorNear;
using testing::vrpn_cookie;
using testing::vrpn_description;
using testing::vrpn_message;
using testing::VrpnDecoder;

constexpr std::size_t kSlots = 2;

std::shared_ptr<const Trackers> trackers() {
  return std::make_shared<const Trackers>(kSlots, true);
}

/// Two people; the head of the first has an asymmetric pose, and the first person's left foot is
/// not tracked.
outlet::TrackerFrame two_persons() {
  outlet::TrackerFrame frame;
  frame.instant = from_unix_ns(1'700'000'000'123'456'000);
  frame.slots = kSlots;
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    outlet::TrackerBody body;
    body.slot = slot;
    for (outlet::TrackerJoint& joint : body.joints) joint.tracked = true;
    frame.bodies.push_back(body);
  }
  outlet::TrackerJoint& head = frame.bodies[0].joints[index_of(JointId::Head)];
  head.position = {1, 2, 3};
  head.orientation = Eigen::AngleAxisd(deg(30), Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(deg(20), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(deg(10), Eigen::Vector3d::UnitZ());
  head.velocity = {0.1, -0.2, 0.3};
  head.angular_velocity = {0, 2, 0};
  frame.bodies[0].joints[index_of(JointId::FootLeft)].tracked = false;
  return frame;
}

struct Heard {
  Conversation conversation;
  VrpnDecoder decoder;
  Result<std::string> last;

  explicit Heard(Peer peer = {"127.0.0.1", true}) : conversation(trackers(), std::move(peer)) {
    decoder.take_stream(Conversation::greeting());
  }
  void say(std::string_view bytes) {
    last = conversation.receive(bytes, testing::kStart);
    if (last) decoder.take_stream(*last);
  }
  /// Sender and sensor, such as "Body0 3", of every pose that this client receives.
  std::multiset<std::string> poses(const Reports& reports) {
    decoder.take_stream(conversation.stream(reports));
    std::multiset<std::string> out;
    for (const auto& message : decoder.messages) {
      if (const auto pose = pose_of(message))
        out.insert(message.sender + " " + std::to_string(pose->sensor));
    }
    decoder.messages.clear();
    return out;
  }
};

TEST(VrpnSession, DescribesEverythingOnceTheCookieIsComplete) {
  Heard client;
  const std::string cookie = vrpn_cookie();
  client.say(cookie.substr(0, 11));
  EXPECT_FALSE(client.conversation.established());
  EXPECT_EQ(client.last.value_or("?"), "");
  client.say(cookie.substr(11));
  EXPECT_TRUE(client.conversation.established());
  EXPECT_EQ(client.decoder.error, "");
  EXPECT_EQ(client.decoder.senders.size(), kSlots * (1 + kJointCount));
  EXPECT_EQ(client.decoder.senders.at(1), "Body1");
  std::set<std::string> names;
  for (const auto& [id, name] : client.decoder.senders) names.insert(name);
  for (const std::string_view joint : kJointNames) {
    EXPECT_TRUE(names.contains("Body0_" + std::string(joint))) << joint;
  }
  // System messages -3 and -4 are missing, because the server accepts no datagrams from clients
  // and keeps no logs.
  EXPECT_EQ(std::set(client.decoder.system_types.begin(), client.decoder.system_types.end()),
            (std::set<std::int32_t>{-2, -1}));
}

TEST(VrpnSession, APoseArrivesAsItIs) {
  Heard client;
  client.say(vrpn_cookie());
  client.decoder.take_stream(client.conversation.stream(encode(two_persons(), *trackers())));
  ASSERT_EQ(client.decoder.error, "");
  int poses = 0;
  int velocities = 0;
  const outlet::TrackerFrame frame = two_persons();
  const outlet::TrackerJoint& head = frame.bodies[0][JointId::Head];
  for (const auto& message : client.decoder.messages) {
    EXPECT_EQ(message.time_us, 1'700'000'000'123'456);
    const bool of_body = message.sender == "Body0";
    const auto pose = pose_of(message);
    const auto velocity = velocity_of(message);
    ASSERT_NE(pose.has_value(), velocity.has_value());
    const int sensor = pose ? pose->sensor : velocity->sensor;
    if (!(of_body && sensor == 3) && message.sender != "Body0_Head") continue;
    EXPECT_EQ(sensor, of_body ? 3 : 0);
    if (pose) {
      ++poses;
      EXPECT_THAT(pose->position, VectorNear(Eigen::Vector3d(1, 2, 3), 0));
      EXPECT_THAT(pose->orientation, RotationNear(head.orientation, 1e-12));
    } else {
      ++velocities;
      EXPECT_THAT(velocity->position, VectorNear(head.velocity, 0));
      EXPECT_GT(velocity->interval, 0);
      const Eigen::Quaterniond turn(
          Eigen::AngleAxisd(2 * velocity->interval, Eigen::Vector3d::UnitY()));
      EXPECT_THAT(velocity->orientation, RotationNear(turn, 1e-12));
    }
  }
  EXPECT_EQ(poses, 2);
  EXPECT_EQ(velocities, 2);
}

TEST(VrpnSession, AnUntrackedJointIsNotSent) {
  Heard client;
  client.say(vrpn_cookie());
  const auto poses = client.poses(encode(two_persons(), *trackers()));
  EXPECT_EQ(poses.size(), 2 * (kSlots * kJointCount - 1));
  EXPECT_EQ(poses.count("Body0 15"), 0u);
  EXPECT_EQ(poses.count("Body0_FootLeft 0"), 0u);
  EXPECT_EQ(poses.count("Body1 15"), 1u);
  EXPECT_EQ(poses.count("Body1_FootLeft 0"), 1u);
}

TEST(VrpnSession, JointTrackersCanBeLeftOut) {
  const Trackers bodies(kSlots, false);
  EXPECT_EQ(bodies.size(), kSlots);
  for (const Report& report : encode(two_persons(), bodies).messages) EXPECT_LT(report.tracker, 2u);
}

TEST(VrpnSession, AClientGetsTheTrackersItNames) {
  const Reports reports = encode(two_persons(), *trackers());
  Heard client;
  client.say(vrpn_cookie() + vrpn_description(-1, 0, "VRPN Control"));
  EXPECT_EQ(client.poses(reports).size(), 98u);  // it named none of ours: gets all
  client.say(vrpn_description(-1, 1, "Body1_Head"));
  EXPECT_EQ(client.poses(reports), (std::multiset<std::string>{"Body1_Head 0"}));
  client.say(vrpn_description(-1, 2, "Body0"));
  EXPECT_EQ(client.poses(reports).size(), 1 + 24u);
}

TEST(VrpnSession, ANameThatIsNoneOfOursIsToldOnce) {
  Conversation conversation(trackers(), {"192.0.2.1", false});
  (void)conversation.receive(
      vrpn_cookie() + vrpn_description(-1, 0, "VRPN Control") + vrpn_description(-1, 1, "Tracker0"),
      from_unix_ns(0));
  EXPECT_EQ(conversation.take_unknown(), "Tracker0");
  EXPECT_EQ(conversation.take_unknown(), std::nullopt);
  (void)conversation.receive(vrpn_description(-1, 2, "Body0"), from_unix_ns(0));
  EXPECT_EQ(conversation.take_unknown(), std::nullopt);
}

TEST(VrpnSession, AnswersPingsToOurTrackersOnly) {
  Heard client;
  client.say(vrpn_cookie() + vrpn_description(-1, 4, "Body1") + vrpn_description(-1, 5, "Other") +
             vrpn_description(-2, 9, "vrpn_Base ping_message"));
  for (const std::int32_t sender : {4, 5, 6, -1, 4}) client.say(vrpn_message(sender, 9, ""));
  ASSERT_EQ(client.decoder.messages.size(), 2u);
  for (const auto& message : client.decoder.messages) {
    EXPECT_EQ(message.sender, "Body1");
    EXPECT_EQ(message.type, "vrpn_Base pong_message");
    EXPECT_EQ(message.payload, "");
    EXPECT_EQ(message.time_us, to_unix_ns(testing::kStart) / 1000);
  }
  EXPECT_EQ(client.decoder.messages.back().sequence, client.decoder.messages.front().sequence + 1);
  client.say(vrpn_description(-2, 9, "vrpn_Tracker Request_Tracker_To_Room"));
  client.say(vrpn_message(4, 9, ""));  // the number now has another meaning
  EXPECT_EQ(client.decoder.messages.size(), 2u);
}

std::string datagram_port(std::int32_t port, const std::string& address) {
  return vrpn_message(port, -3, address + std::string(1, '\0'));
}

TEST(VrpnSession, SendsDatagramsOnlyToTheClientsOwnAddress) {
  for (const auto& [port, address] :
       std::vector<std::pair<std::int32_t, std::string>>{{5000, "127.0.0.2"},
                                                         {5000, ""},
                                                         {80, "127.0.0.1"},
                                                         {-5, "127.0.0.1"},
                                                         {70000, "127.0.0.1"},
                                                         {5000, "127.0.0.1 "}}) {
    Heard client;
    client.say(vrpn_cookie() + datagram_port(port, address));
    EXPECT_THAT(client.last, IsOk());
    EXPECT_FALSE(client.conversation.datagram_port()) << port << " " << address;
  }
  Heard by_tcp({"127.0.0.1", false});
  by_tcp.say(vrpn_cookie() + datagram_port(5000, "127.0.0.1"));
  EXPECT_FALSE(by_tcp.conversation.datagram_port());
  Heard by_udp;
  by_udp.say(vrpn_cookie() + datagram_port(5000, "127.0.0.1"));
  EXPECT_EQ(by_udp.conversation.datagram_port(), 5000);
}

TEST(VrpnSession, DatagramsHoldWholeMessagesAndAreFull) {
  Heard client;
  client.say(vrpn_cookie());
  const auto datagrams = client.conversation.datagrams(encode(two_persons(), *trackers()));
  std::size_t bytes = 0;
  for (const std::string& datagram : datagrams) {
    client.decoder.take_datagram(datagram);
    bytes += datagram.size();
  }
  EXPECT_EQ(client.decoder.error, "");
  EXPECT_EQ(client.decoder.messages.size(), 2u * 98);
  EXPECT_LE(datagrams.size(), bytes / (1472 - 96) + 1);  // none has room for another message
  std::uint32_t sequence = 0;
  for (const auto& message : client.decoder.messages) EXPECT_EQ(message.sequence, sequence++);
}

TEST(VrpnSession, WhatCannotBeVrpnEndsIt) {
  std::string short_length = vrpn_message(0, 0, "");
  short_length[3] = 23;
  std::string long_count = vrpn_description(-1, 0, "Body0");
  long_count[24 + 3] = 99;
  std::string bad_type = vrpn_description(-2, 0, "x");
  bad_type[24] = '\x7F';
  for (const std::string& bad : {short_length, long_count, bad_type, vrpn_description(-1, -1, "x"),
                                 vrpn_description(-1, 2000, "x"), vrpn_description(-2, 2000, "x"),
                                 std::string("\xFF\xFF\xFF\xFF"), std::string(8, '\0')}) {
    Heard client;
    client.say(vrpn_cookie() + bad);
    EXPECT_THAT(client.last, FailsWith(ErrorCode::Malformed));
  }
  Heard stranger;
  stranger.say("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(stranger.last, FailsWith(ErrorCode::Malformed));
  EXPECT_FALSE(stranger.conversation.established());
}

TEST(VrpnSession, WhatItDoesNotKnowIsPassedOver) {
  Heard client;
  client.say(vrpn_cookie() + vrpn_message(3, -4, std::string(8, 'x')) + vrpn_message(0, -5, "") +
             vrpn_message(0, -77, "abc") + vrpn_message(1999, 1999, std::string(1032, 't')));
  ASSERT_THAT(client.last, IsOk());
  EXPECT_TRUE(client.decoder.messages.empty());
}

}  // namespace
}  // namespace chorus::vrpn
