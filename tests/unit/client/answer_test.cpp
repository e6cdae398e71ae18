// How a sensor's answers are interpreted, honest ones or not.
#include "common/client/answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/client/frames.h"
#include "common/resource/floor_plane_resource.h"
#include "tests/support/builders.h"

namespace chorus::client {
namespace {

using ::testing::HasSubstr;
using testing::kStart;
using testing::sensor_id;
using ::testing::StartsWith;

resource::FrameResource answered_frame(const std::string& source) {
  const auto pose = testing::ring_sensor(0, 6);
  return resource::to_resource(testing::sensor_frame(
      source, kStart, {testing::body_seen_from(pose, testing::standing_person(), kStart)}));
}

http::ClientResponse answer(int status, std::string type, std::string body) {
  http::ClientResponse response;
  response.status = status;
  response.headers["content-type"] = std::move(type);
  response.headers["etag"] = "\"42-ttl\"";
  response.body = std::move(body);
  response.sent_ns = to_unix_ns(kStart);
  response.received_ns = to_unix_ns(kStart + std::chrono::milliseconds(2));
  return response;
}

http::ClientResponse turtle(const resource::FrameResource& f) {
  return answer(200, "text/turtle", write(f, resource::Format::Turtle));
}

Answer read_frame_answer(const http::ClientResponse& response, const SensorId& expected) {
  return read_answer(response, kFrames, expected);
}

/// The frame that was read; null: none.
const resource::FrameResource* frame_in(const Document& document) {
  return static_cast<const resource::FrameResource*>(document.value.get());
}

std::string why(const Answer& read) {
  const auto* unreadable = std::get_if<Unreadable>(&read.event);
  return unreadable == nullptr ? "" : to_string(unreadable->error);
}

TEST(ClockAnswer, SaysWhatTheHostSaysOfItsClock) {
  const auto host = read_clock_answer(
      answer(200, "application/json",
             R"({"@type": "Clock", "nowNanoseconds": "1795246200250000000", "synchronised": true,
                 "offsetNanoseconds": -1500, "maxErrorNanoseconds": 2000000,
                 "estimatedErrorNanoseconds": "3000", "frequencyPpm": -12.5})"));
  ASSERT_TRUE(host);
  EXPECT_TRUE(host->synchronised);
  EXPECT_EQ(host->offset, Duration(-1500));
  EXPECT_EQ(host->max_error, std::chrono::milliseconds(2));
  EXPECT_EQ(host->est_error, std::chrono::microseconds(3));
}

TEST(ClockAnswer, IsNothingWhenItIsNone) {
  for (const char* text : {"", "[]", "{}", R"({"synchronised": "yes"})", "@prefix ch: <x> ."})
    EXPECT_FALSE(read_clock_answer(answer(200, "application/json", text))) << text;
  EXPECT_FALSE(read_clock_answer(answer(404, "application/json", R"({"synchronised": true})")));
}

TEST(FrameAnswer, IsAFrameInEveryFormatASensorWrites) {
  for (const auto format :
       {resource::Format::Turtle, resource::Format::Json, resource::Format::JsonLd}) {
    const auto type = std::string(media_type(format)) + "; charset=utf-8";
    const auto read =
        read_frame_answer(answer(200, type, write(answered_frame("s1"), format)), sensor_id("s1"));
    ASSERT_NE(frame_in(read.document), nullptr) << type << why(read);
    const auto& event = std::get<FrameAnswered>(read.event);
    EXPECT_EQ(event.etag, "\"42-ttl\"");
    EXPECT_EQ(event.captured, kStart);
    EXPECT_EQ(frame_in(read.document)->bodies.size(), 1u);
  }
}

TEST(FrameAnswer, PassesStatusesOnWithoutReadingTheBody) {
  const auto read = read_frame_answer(answer(304, "", ""), sensor_id("s1"));
  EXPECT_EQ(std::get<FrameAnswered>(read.event).status, 304);
  EXPECT_EQ(frame_in(read.document), nullptr);
}

TEST(FrameAnswer, RefusesWebPagesNonsenseAndStrangers) {
  EXPECT_NE(
      why(read_frame_answer(answer(200, "text/html", "<html>"), sensor_id("s1"))).find("text/html"),
      std::string::npos);
  EXPECT_NE(why(read_frame_answer(answer(200, "text/turtle", "no turtle"), sensor_id("s1"))), "");
  EXPECT_NE(why(read_frame_answer(answer(200, "text/turtle", ""), sensor_id("s1"))), "");
  EXPECT_NE(
      why(read_frame_answer(answer(200, "text/turtle", std::string(20000, '[')), sensor_id("s1"))),
      "");
  EXPECT_EQ(
      why(read_frame_answer(turtle(answered_frame("s2")), sensor_id("s1"))),
      "frame: the service calls itself \"s2\", the config calls it \"s1\"; make both the same");
}

TEST(FrameAnswer, ADocumentOfThousandsOfStrangersIsRefusedEarly) {
  std::string text = "@prefix ch: <https://w3id.org/chorus-tracking/ns#> .\n";
  for (int i = 0; i < 5000; ++i) text += "<x" + std::to_string(i) + "> a ch:Joint .\n";
  EXPECT_NE(why(read_frame_answer(answer(200, "text/turtle", text), sensor_id("s1"))).find("4096"),
            std::string::npos);
}

TEST(FrameEvent, IsJsonOrTurtle) {
  for (const auto format : {resource::Format::Turtle, resource::Format::Json}) {
    const auto read = read_event(write(answered_frame("s1"), format), kFrames, sensor_id("s1"));
    ASSERT_TRUE(read) << media_type(format);
    EXPECT_EQ(frame_in(*read)->bodies.size(), 1u);
    EXPECT_FALSE(read_event(write(answered_frame("s1"), format), kFrames, sensor_id("s2")));
  }
  EXPECT_FALSE(read_event("", kFrames, sensor_id("s1")));
}

TEST(Untimely, IsTheFutureAndThePastButNotTheDelay) {
  const auto at = [&](Duration received) { return untimely({1, kStart, kStart + received}); };
  EXPECT_FALSE(at(std::chrono::milliseconds(150)));
  EXPECT_FALSE(at(std::chrono::seconds(-1)));
  EXPECT_NE(to_string(*at(std::chrono::hours(1))).find("3600.0 s behind"), std::string::npos);
  EXPECT_NE(to_string(*at(std::chrono::hours(-1))).find("3600.0 s ahead of"), std::string::npos);
}

TEST(FrameAnswer, ARefusedContentTypeIsQuotedOnlyInPart) {
  const auto read = read_frame_answer(answer(200, std::string(5000, 'x'), ""), sensor_id("s1"));
  EXPECT_LT(why(read).size(), 200u);
}

TEST(FrameAnswer, AFusionServerIsASensorWhateverItIsCalled) {
  auto fused = answered_frame("fusion");
  fused.space = resource::SpaceKind::World;
  fused.sensors = {"s1", "s2"};
  const auto read = read_frame_answer(turtle(fused), sensor_id("cell1"));
  ASSERT_NE(frame_in(read.document), nullptr) << why(read);
  const auto placed =
      place_in_time({sensor_id("cell1"),
                     std::make_shared<resource::FrameResource>(*frame_in(read.document)),
                     kStart,
                     {},
                     {}});
  EXPECT_EQ(placed.sensor, sensor_id("cell1"));
  ASSERT_TRUE(placed.floor);  // the floor of its world is y = 0
  EXPECT_EQ(placed.floor->normal, Eigen::Vector3d::UnitY());
  EXPECT_EQ(placed.floor->offset, 0.0);
}

TEST(PlaceInTime, ShiftsCaptureTimesOfFrameAndBodiesAndAddsTheFloor) {
  const FloorPlane floor{Eigen::Vector3d::UnitY(), 1.2};
  const auto shift = std::chrono::milliseconds(-250);
  const ClockEstimate clock{shift, std::chrono::milliseconds(1)};
  const auto placed = place_in_time(
      {sensor_id("s1"), std::make_shared<resource::FrameResource>(answered_frame("s1")), kStart,
       clock, floor});
  EXPECT_EQ(placed.captured, kStart + shift);
  ASSERT_EQ(placed.bodies.size(), 1u);
  EXPECT_EQ(placed.bodies[0].captured, kStart + shift);
  EXPECT_EQ(placed.clock_sigma, clock_sigma(clock));
  EXPECT_EQ(placed.floor->offset, 1.2);
  EXPECT_EQ(placed.received, kStart);
}

TEST(FloorAnswer, ReadsAPlane) {
  const FloorPlane floor{Eigen::Vector3d(0, 0.8, 0.6), 1.25};
  const auto node = resource::floor_plane_node(floor, resource::SpaceKind::Sensor);
  for (const auto format : {resource::Format::Turtle, resource::Format::Json}) {
    const auto read =
        read_floor_answer(answer(200, std::string(media_type(format)), write(node, format)));
    ASSERT_TRUE(read && *read) << media_type(format);
    EXPECT_NEAR(((*read)->normal - floor.normal).norm(), 0, 1e-4);
    EXPECT_NEAR((*read)->offset, 1.25, 1e-4);
  }
  const auto none = read_floor_answer(answer(404, "application/problem+json", "{}"));
  EXPECT_TRUE(none && !*none) << "a sensor may have none";
}

TEST(FloorAnswer, SaysWhatIsWrongWithAnythingElse) {
  const auto wrong = [](const char* type, std::string body) {
    const auto read = read_floor_answer(answer(200, type, std::move(body)));
    return read ? std::string("taken") : to_string(read.error());
  };
  EXPECT_THAT(wrong("text/turtle", "nonsense"), StartsWith("floor-plane: "));
  EXPECT_THAT(wrong("text/html", "<p>"), HasSubstr("text/html"));
  EXPECT_THAT(wrong("application/json", R"({"normalX":0,"normalY":0,"normalZ":0,"offset":1})"),
              StartsWith("floor-plane: "));
  EXPECT_THAT(wrong("application/json", std::string(100'000, ' ')), HasSubstr("longer"));
}

TEST(ExchangeOf, NeedsTheHeader) {
  auto response = answer(200, "text/turtle", "");
  EXPECT_FALSE(exchange_of(response));
  response.headers["chorus-clock"] = "1795246200000000000 1795246200001000000";
  const auto exchange = exchange_of(response);
  ASSERT_TRUE(exchange);
  EXPECT_EQ(exchange->sent, kStart);
  EXPECT_EQ(exchange->their_sending - exchange->their_receipt, std::chrono::milliseconds(1));
  response.headers["chorus-clock"] = "now then";
  EXPECT_FALSE(exchange_of(response));
}

}  // namespace
}  // namespace chorus::client
