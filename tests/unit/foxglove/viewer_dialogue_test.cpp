// A viewer that speaks foxglove.websocket.v1, without a socket.
#include "fusion-server/foxglove/viewer_dialogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fusion-server/foxglove/messages.h"
#include "tests/unit/rest/asked.h"

namespace chorus::foxglove {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

class Viewer : public ::testing::Test {
 protected:
  /// The number of a topic's channel in what was advertised.
  std::uint32_t channel_of(const std::string& topic) {
    for (const Channel& one : desk_.channels()) {
      if (one.topic == topic) return one.id;
    }
    return 0;
  }
  http::Reply subscribe(std::uint32_t id, std::uint32_t channel) {
    return viewer_.hear(
        Json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}}
            .dump());
  }

  Desk desk_;
  ViewerDialogue viewer_{desk_, "the tracker", "run1"};
};

TEST_F(Viewer, IsToldWhatThereIsAndWhatIsAdded) {
  const http::Reply hello = viewer_.look();
  ASSERT_EQ(hello.messages.size(), 2u);
  EXPECT_EQ(Json::parse(hello.messages[0]).at("op"), "serverInfo");
  const Json channels = Json::parse(hello.messages[1]).at("channels");
  ASSERT_EQ(channels.size(), 4u);
  for (const Json& channel : channels) {
    EXPECT_EQ(channel.at("encoding"), "json");
    EXPECT_TRUE(Json::parse(channel.at("schema").get<std::string>()).is_object())
        << channel.at("topic");
  }
  EXPECT_THAT(viewer_.look().messages, IsEmpty());
  const auto frame = std::make_shared<resource::FrameResource>();
  desk_.raw(testing::sensor_id("s1"), frame, testing::kStart);
  const http::Reply more = viewer_.look();
  ASSERT_EQ(more.messages.size(), 1u);
  EXPECT_THAT(more.messages[0], HasSubstr("/sensors/s1/scene"));
  EXPECT_THAT(more.binary, IsEmpty()) << "nothing was asked for";
}

TEST_F(Viewer, GetsTheNewestOfWhatItSubscribedToOnce) {
  (void)viewer_.look();
  desk_.publish(rest::snapshot(1));
  EXPECT_THAT(viewer_.look().binary, IsEmpty());
  const http::Reply first = subscribe(70'000, channel_of("/frame"));
  ASSERT_EQ(first.binary.size(), 1u) << "the newest at once";
  const std::string& bytes = first.binary[0];
  EXPECT_EQ(bytes.substr(0, 5), std::string("\x01\x70\x11\x01\x00", 5)) << "little-endian";
  std::uint64_t time = 0;
  for (int i = 7; i >= 0; --i) time = time << 8 | static_cast<std::uint8_t>(bytes[5 + i]);
  EXPECT_EQ(time, static_cast<std::uint64_t>(to_unix_ns(rest::snapshot(1)->instant)));
  EXPECT_EQ(Json::parse(bytes.substr(13)).at("sequence"), 1);
  EXPECT_THAT(viewer_.look().binary, IsEmpty());
  desk_.publish(rest::snapshot(2));
  desk_.publish(rest::snapshot(3));
  const http::Reply next = viewer_.look();
  ASSERT_EQ(next.binary.size(), 1u);
  EXPECT_EQ(Json::parse(next.binary[0].substr(13)).at("sequence"), 3);
  desk_.publish(rest::snapshot(4));
  EXPECT_THAT(viewer_.hear(R"({"op": "unsubscribe", "subscriptionIds": [70000]})").binary,
              IsEmpty());
}

TEST_F(Viewer, GetsScenesAndTransforms) {
  desk_.publish(rest::snapshot(1));
  Registration registration;
  registration.version = 3;
  registration.sensors[testing::sensor_id("s1")] = {};
  desk_.places(registration, testing::kStart);
  const auto scene = subscribe(1, channel_of("/scene")).binary;
  ASSERT_EQ(scene.size(), 1u);
  EXPECT_EQ(Json::parse(scene[0].substr(13)).at("entities").size(), 1u);
  const auto transforms = subscribe(2, channel_of("/transforms")).binary;
  ASSERT_EQ(transforms.size(), 1u);
  EXPECT_THAT(transforms[0], HasSubstr("s1"));
  desk_.places(registration, testing::kStart);
  EXPECT_THAT(viewer_.look().binary, IsEmpty()) << "nothing has moved";
}

TEST_F(Viewer, IsToldWhatItDoesWrong) {
  (void)viewer_.look();
  for (const char* wrong :
       {"", "{", "[]", R"({"op": 7})", R"({"op": "subscribe"})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 4294967296}]})",
        R"({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 99}]})",
        R"({"op": "unsubscribe", "subscriptionIds": ["x"]})"}) {
    const http::Reply reply = viewer_.hear(wrong);
    ASSERT_EQ(reply.messages.size(), 1u) << wrong;
    EXPECT_EQ(Json::parse(reply.messages[0]).at("op"), "status");
    EXPECT_FALSE(reply.over);
  }
  EXPECT_THAT(viewer_.hear(R"({"op": "getParameters"})").messages, IsEmpty()) << "not our affair";
}

}  // namespace
}  // namespace chorus::foxglove
