// What is sent to a pusher, message by message.
#include "services/sensor/device/bridge/push_dialogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/matchers.h"
#include "tests/unit/push/push_rig.h"

namespace chorus::bridge {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using std::chrono::milliseconds;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string kHello = R"({"type":"hello","name":"cam","layout":"coco_17"})";

class Talk : public ::testing::Test {
 protected:
  Talk() : talk(*open_dialogue(rig.desk, "WebSocket", "127.0.0.1")) {}

  Json said(const http::Reply& reply, std::size_t i = 0) {
    EXPECT_GT(reply.messages.size(), i);
    return reply.messages.size() > i ? Json::parse(reply.messages[i]) : Json();
  }

  PushRig rig;
  std::unique_ptr<http::Dialogue> talk;
};

TEST_F(Talk, BeginsWithAWelcomeAndAQuestionForTheTime) {
  const auto reply = talk->hear(kHello);
  EXPECT_FALSE(reply.over);
  const Json welcome = said(reply);
  EXPECT_EQ(welcome["type"], "welcome");
  EXPECT_EQ(welcome["sensor"], "s1");
  EXPECT_THAT(welcome["joints"].dump(), HasSubstr("SpineShoulder"));
  EXPECT_EQ(welcome["joints"].dump().find("ThumbLeft"), std::string::npos) << "COCO has no thumbs";
  const Json question = said(reply, 1);
  EXPECT_EQ(question["type"], "clock");
  EXPECT_EQ(question["sent"], std::to_string(to_unix_ns(kStart)));
}

TEST_F(Talk, AsksForTheTimeEightTimesAndThenOnceASecond) {
  Json question = said(talk->hear(kHello), 1);
  int questions = 1;
  while (true) {
    rig.pass(milliseconds(1));
    const std::string now = std::to_string(to_unix_ns(rig.clock->now()));
    const auto reply = talk->hear(Json{
        {"type", "clock"},
        {"sent", question["sent"]},
        {"received", now},
        {"answered", now}}.dump());
    if (reply.messages.empty()) break;
    question = said(reply);
    ASSERT_LT(++questions, 20);
  }
  EXPECT_EQ(questions, 8);
  EXPECT_TRUE(talk->look().messages.empty());
  rig.pass(std::chrono::seconds(1));
  EXPECT_EQ(said(talk->look())["type"], "clock");
}

TEST_F(Talk, ErrorsComeOnceASecondWithTheCountOfTheOthers) {
  (void)talk->hear(kHello);
  const Json first = said(talk->hear("{}"));
  EXPECT_EQ(first["type"], "error");
  EXPECT_EQ(first["context"], "type");
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(talk->hear("{}").messages.empty());
  rig.pass(milliseconds(1001));
  EXPECT_EQ(said(talk->hear("{}"))["unsaid"], 5);
}

TEST_F(Talk, DoubtsAreToldOnceWhileFramesAreTaken) {
  (void)talk->hear(kHello);
  rig.pass(std::chrono::seconds(1));
  std::vector<std::string> told;
  for (int i = 0; i < 40; ++i) {
    rig.pass(milliseconds(100));
    const std::string now = std::to_string(to_unix_ns(rig.clock->now()));
    const auto reply =
        talk->hear(R"({"type":"frame","captured":")" + now +
                   R"(","bodies":[{"id":1,"points":{"nose":[0,-0.6,2],"left_shoulder":[0,-0.5,2],)"
                   R"("right_shoulder":[0.1,-0.5,2],"left_ankle":[0,0.9,2]}}]})");
    told.insert(told.end(), reply.messages.begin(), reply.messages.end());
  }
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(Json::parse(told[0])["type"], "doubt");
  EXPECT_THAT(Json::parse(told[0])["detail"], HasSubstr("does y point down?"));
  EXPECT_EQ(rig.desk->status().frames, 40U);
  EXPECT_THAT(rig.desk->status().doubt, HasSubstr("head below the feet"));
}

TEST_F(Talk, EndsAfterTooManyErrorsInARow) {
  (void)talk->hear(kHello);
  int refused = 0;
  http::Reply reply;
  while (!reply.over && refused < 1000) {
    rig.pass(milliseconds(10));
    reply = talk->hear("{}");
    ++refused;
  }
  EXPECT_EQ(refused, 301);
  EXPECT_EQ(said(reply)["type"], "bye");
}

TEST_F(Talk, EndsWithoutAHello) {
  rig.pass(std::chrono::seconds(4));
  EXPECT_FALSE(talk->look().over);
  rig.pass(std::chrono::seconds(2));
  const auto reply = talk->look();
  EXPECT_TRUE(reply.over);
  EXPECT_THAT(said(reply)["detail"], HasSubstr("hello"));
}

TEST_F(Talk, EndsWhenNothingComesAnyMore) {
  (void)talk->hear(kHello);
  rig.pass(std::chrono::seconds(31));
  EXPECT_TRUE(talk->look().over);
}

TEST_F(Talk, SaysWhyTheCarrierEndsItAndSoDoesTheDesk) {
  (void)talk->hear(kHello);
  const auto reply = talk->end({ErrorCode::TooLarge, {}, "a message has at most 262144 bytes"});
  EXPECT_TRUE(reply.over);
  EXPECT_EQ(said(reply)["type"], "bye");
  EXPECT_THAT(said(reply)["detail"], HasSubstr("max_message_kb"));
  talk.reset();
  EXPECT_THAT(rig.desk->status().reason, HasSubstr("at most 262144 bytes"));
}

TEST_F(Talk, EndsWhenAnotherProgramTookThePlace) {
  (void)talk->hear(kHello);
  rig.pass(std::chrono::seconds(3));
  auto other = *open_dialogue(rig.desk, "local socket", "");
  EXPECT_EQ(said(other->hear(kHello))["type"], "welcome");
  const auto reply = talk->look();
  EXPECT_TRUE(reply.over);
  EXPECT_THAT(said(reply)["detail"], HasSubstr("another program"));
}

TEST_F(Talk, ASecondProgramIsSentAway) {
  (void)talk->hear(kHello);
  auto other = *open_dialogue(rig.desk, "WebSocket", "10.0.0.9");
  const auto reply = other->hear(kHello);
  EXPECT_TRUE(reply.over);
  EXPECT_THAT(said(reply)["detail"], HasSubstr("\"cam\""));
}

TEST_F(Talk, TheOldestSilentConnectionLeavesForANewOneOfItsWayIn) {
  const std::size_t most = 4 * BridgeSettings{}.max_pushers;  // `talk` is one of them
  std::vector<std::unique_ptr<http::Dialogue>> others;
  for (std::size_t i = 1; i < most; ++i)
    others.push_back(*open_dialogue(rig.desk, "WebSocket", ""));
  others.push_back(*open_dialogue(rig.desk, "local socket", ""));
  EXPECT_FALSE(talk->look().over);
  others.push_back(*open_dialogue(rig.desk, "WebSocket", ""));
  EXPECT_TRUE(talk->look().over);
  EXPECT_FALSE(others.front()->look().over);
}

}  // namespace
}  // namespace chorus::bridge
