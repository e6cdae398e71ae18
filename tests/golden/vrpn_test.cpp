// Our VRPN server writes the files in proto/golden/vrpn byte for byte, and the tests' own client
// reads them.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "fusion-server/vrpn/vrpn_conversation.h"
#include "tests/support/matchers.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::vrpn {
namespace {

constexpr Timestamp kTime = from_unix_ns(1'795'246'200'123'456'789);

std::string golden(const std::string& name) {
  std::ifstream file("proto/golden/vrpn/" + name + ".bin", std::ios::binary);
  EXPECT_TRUE(file) << name;
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

std::shared_ptr<const Trackers> one_person() { return std::make_shared<const Trackers>(1, true); }

/// The head of one person, as in frame.json.
outlet::TrackerFrame frame() {
  outlet::TrackerFrame frame;
  frame.instant = kTime;
  frame.slots = 1;
  outlet::TrackerBody body;
  outlet::TrackerJoint& head = body.joints[index_of(JointId::Head)];
  head.tracked = true;
  head.position = {1, 2, 3};
  head.orientation = {0.5, 0.5, -0.5, 0.5};
  head.velocity = {0.25, -0.5, 0.125};
  frame.bodies.push_back(body);
  return frame;
}

Conversation greeted() {
  Conversation conversation(one_person(), {"127.0.0.1", true});
  EXPECT_THAT(conversation.receive(testing::vrpn_cookie(), kTime), testing::IsOk());
  return conversation;
}

TEST(VrpnGolden, CookieAndDescriptions) {
  EXPECT_EQ(Conversation::greeting(), golden("cookie"));
  Conversation conversation(one_person(), {});
  EXPECT_EQ(conversation.receive(testing::vrpn_cookie(), kTime).value_or(""),
            golden("descriptions"));
}

TEST(VrpnGolden, AFrameInTheStreamAndAsADatagram) {
  const Reports reports = encode(frame(), *one_person());
  EXPECT_EQ(greeted().stream(reports), golden("frame"));
  EXPECT_EQ(greeted().datagrams(reports), std::vector<std::string>{golden("frame")});
}

TEST(VrpnGolden, Pong) {
  Conversation conversation = greeted();
  const auto answer =
      conversation.receive(testing::vrpn_description(-1, 3, "Body0") +
                               testing::vrpn_description(-2, 1, "vrpn_Base ping_message") +
                               testing::vrpn_message(3, 1, ""),
                           kTime);
  EXPECT_EQ(answer.value_or(""), golden("pong"));
}

TEST(VrpnGolden, ReadsBackAsWhatItSays) {
  testing::VrpnDecoder client;
  client.take_stream(golden("cookie") + golden("descriptions") + golden("frame"));
  ASSERT_EQ(client.error, "");
  ASSERT_EQ(client.messages.size(), 4u);
  const auto pose = pose_of(client.messages[2]);
  const auto velocity = velocity_of(client.messages[3]);
  ASSERT_TRUE(pose && velocity);
  EXPECT_EQ(client.messages[2].sender, "Body0_Head");
  EXPECT_EQ(client.messages[2].time_us, 1'795'246'200'123'456);
  EXPECT_THAT(pose->position, testing::VectorNear(Eigen::Vector3d(1, 2, 3), 0));
  EXPECT_EQ(pose->orientation.w(), 0.5);
  EXPECT_EQ(pose->orientation.y(), -0.5);
  EXPECT_EQ(velocity->interval, 0.01);
}

TEST(Vrpn, ThingsInHandsAreTrackersOfTheirOwn) {
  const auto trackers =
      std::make_shared<const Trackers>(1, true, std::vector<std::string>{"box", "driver"});
  outlet::TrackerFrame things = frame();
  things.props = {{"box", 0, {}}, {"driver", 0, {.position = {4, 5, 6}, .tracked = true}}};
  Conversation conversation(trackers, {"127.0.0.1", true});
  testing::VrpnDecoder client;
  const auto answer = conversation.receive(testing::vrpn_cookie(), kTime);
  ASSERT_TRUE(answer);
  client.take_stream(Conversation::greeting() + *answer +
                     conversation.stream(encode(things, *trackers)));
  ASSERT_EQ(client.error, "");
  ASSERT_EQ(client.messages.size(), 6u);
  EXPECT_EQ(client.messages[4].sender, "driver");
  EXPECT_THAT(pose_of(client.messages[4])->position,
              testing::VectorNear(Eigen::Vector3d(4, 5, 6), 1e-9));
}

}  // namespace
}  // namespace chorus::vrpn
