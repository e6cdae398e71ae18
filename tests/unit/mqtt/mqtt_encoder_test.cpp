#include "fusion-server/mqtt/mqtt_encoder.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/body/bones.h"
#include "fusion-server/mqtt/mqtt_outlet.h"

namespace chorus::mqtt {
namespace {

TEST(AnMqttPayload, HasTheTrackedJointsToAHundredthOfAMillimetre) {
  outlet::TrackerFrame frame;
  frame.sequence = 12;
  frame.instant = from_unix_ns(1'795'246'200'123'456'789);
  outlet::TrackerBody body;
  body.person = PersonId{7};
  body.slot = 2;
  outlet::TrackerJoint& head = body.joints[index_of(JointId::Head)];
  head.tracked = true;
  head.position = {1.234567, -2, 0.000004};
  outlet::TrackerJoint& neck = body.joints[index_of(JointId::Neck)];
  neck.tracked = neck.oriented = true;
  const auto json = nlohmann::json::parse(encode(frame, body));
  EXPECT_EQ(json.at("id"), 7);
  EXPECT_EQ(json.at("slot"), 2);
  EXPECT_EQ(json.at("sequence"), 12);
  EXPECT_EQ(json.at("at"), "1795246200123456789");
  ASSERT_EQ(json.at("joints").size(), 2U);
  EXPECT_EQ(json.at("joints").at("Head").at("place"), nlohmann::json({1.23457, -2.0, 0.0}));
  EXPECT_FALSE(json.at("joints").at("Head").contains("orientation"));
  EXPECT_EQ(json.at("joints").at("Neck").at("orientation"), nlohmann::json({0.0, 0.0, 0.0, 1.0}));
}

TEST(AnMqttPayload, OfNobodySeenIsStillAnObject) {
  EXPECT_TRUE(nlohmann::json::parse(encode({}, {})).at("joints").empty());
  EXPECT_TRUE(nlohmann::json::parse(kGone).at("gone"));
}

TEST(AnMqttTopic, HasNoWildcardsAndNoEmptyLevels) {
  EXPECT_EQ(person_topic("chorus/hall/a", PersonId{7}), "chorus/hall/a/people/7");
  EXPECT_EQ(status_topic("chorus/hall/a"), "chorus/hall/a/status");
  for (const char* good : {"chorus/hall/a", "a", "Halle 3/Zelle"}) EXPECT_TRUE(is_topic(good));
  for (const char* bad : {"", "a/", "/a", "a//b", "a/#", "+/a", "$SYS/a", "a\nb"})
    EXPECT_FALSE(is_topic(bad)) << bad;
  EXPECT_FALSE(is_topic(std::string(300, 'a')));
}

TEST(AnMqttOutlet, IsOpenWithoutABrokerAndCountsWhatItDrops) {
  Settings settings;
  settings.port = 9;  // the discard service, which nobody runs
  const auto opened = open_outlet(settings, {});
  ASSERT_TRUE(opened);
  outlet::TrackerFrame frame;
  frame.instant = from_unix_ns(1'795'246'200'000'000'000);
  (*opened)->send(frame);
  EXPECT_EQ((*opened)->counters().dropped, 1U);
  EXPECT_EQ((*opened)->counters().clients, 0U);
}

TEST(AnMqttOutlet, SaysThatItsAuthorityCannotBeRead) {
  Settings settings;
  settings.ca_file = "/nowhere/ca.crt";
  const auto opened = open_outlet(settings, {});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().context, "/nowhere/ca.crt");
}

TEST(MqttSettings, AreRefusedByName) {
  auto reader = ConfigReader::parse(
      R"({"topic": "a/#", "server": "", "password": "p", "max_rate_hz": 0})", "test");
  ASSERT_TRUE(reader);
  Settings settings;
  read_settings(*reader, settings);
  const auto done = reader->finish();
  ASSERT_FALSE(done);
  for (const char* key : {"topic", "server", "password", "max_rate_hz"})
    EXPECT_NE(to_string(done.error()).find(key), std::string::npos) << key;
}

}  // namespace
}  // namespace chorus::mqtt
