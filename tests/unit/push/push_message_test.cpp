// What pushers send, line by line: what is accepted, and how refusals are worded.
#include "services/sensor/device/bridge/push_message.h"

#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/matchers.h"

namespace chorus::bridge {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::VectorNear;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const Json kHelloMessage{{"type", "hello"}, {"name", "cam"}, {"layout", "coco_17"}};
const std::string kTime = "1795246200250000000";

Json with(Json message, const char* key, Json value) {
  message[key] = std::move(value);
  return message;
}

Hello hello_of(const Json& message) {
  auto read = read_push_message(message.dump(), nullptr);
  EXPECT_THAT(read, IsOk());
  return read ? std::get<Hello>(*read) : Hello{};
}

/// 17 landmarks, all null except those in `given`.
Json landmarks(const std::map<std::size_t, Json>& given) {
  Json all = Json::array();
  for (std::size_t i = 0; i < 17; ++i) all.push_back(given.contains(i) ? given.at(i) : Json());
  return all;
}

Json frame_of(const char* key, const Json& all) {
  return {{"type", "frame"}, {"captured", kTime}, {"bodies", {{{"id", 7}, {key, all}}}}};
}

Result<PushedFrame> read_frame(const Json& frame, const Json& hello = kHelloMessage) {
  const Hello known = hello_of(hello);
  return read_push_message(frame.dump(), &known).map([](PushMessage&& message) {
    return std::get<PushedFrame>(std::move(message));
  });
}

const Joint& joint_of(const Result<PushedFrame>& frame, JointId id) {
  return frame->bodies.at(0).skeleton[id];
}

void expect_refused(const Json& message, const std::string& context, const std::string& says,
                    const Json& hello = kHelloMessage) {
  const Hello known = hello_of(hello);
  const auto read = read_push_message(message.dump(), &known);
  ASSERT_FALSE(read) << message;
  EXPECT_EQ(read.error().context, context) << message;
  EXPECT_THAT(read.error().message, HasSubstr(says)) << message;
}

TEST(Hello, SaysWhoWhatAndHow) {
  const Hello hello = hello_of({{"type", "hello"},
                                {"version", 1},
                                {"name", "door camera"},
                                {"layout", "mediapipe_33"},
                                {"axes", "right down ahead"},
                                {"floor", {0.0, -1.0, 0.0, 1.5}},
                                {"trackedFrom", 0.7},
                                {"pixelSigma", 2.5},
                                {"focalSigma", 0.1},
                                {"somethingNew", true}});
  EXPECT_EQ(hello.name, "door camera");
  EXPECT_EQ(hello.layout->name, "mediapipe_33");
  EXPECT_THAT((hello.sensor_from_pusher * Eigen::Vector3d(1, 2, 3)).eval(),
              VectorNear(Eigen::Vector3d(-1, -2, 3), 0.0));
  ASSERT_TRUE(hello.floor);
  EXPECT_THAT(hello.floor->normal, VectorNear(Eigen::Vector3d(0, 1, 0), 1e-12));
  EXPECT_DOUBLE_EQ(hello.floor->offset, 1.5);
  EXPECT_DOUBLE_EQ(hello.tracked_from, 0.7);
  EXPECT_DOUBLE_EQ(hello.inferred_from, hello.layout->inferred_from);
  EXPECT_EQ(hello.pixel_sigma, 2.5);
  EXPECT_EQ(hello.focal_sigma, 0.1);
}

TEST(Hello, ACeilingCameraMayLookBeyondStraightDown) {
  const Hello hello = hello_of(with(kHelloMessage, "floor", {0.0, -0.04, -1.0, 3.2}));
  ASSERT_TRUE(hello.floor);
  EXPECT_LT(hello.floor->normal.y(), 0.0);
}

TEST(Hello, AxesAreThreeDirectionsAtRightAngles) {
  for (const char* words : {"left up ahead", "ahead left up", "right up back", "down back left"}) {
    const auto axes = read_axes(words);
    ASSERT_THAT(axes, IsOk()) << words;
    EXPECT_NEAR(std::abs(axes->determinant()), 1.0, 1e-12);
  }
  EXPECT_EQ(read_axes("left up ahead")->determinant(), 1.0);
  EXPECT_EQ(read_axes("right up ahead")->determinant(), -1.0) << "left-handed";
  for (const char* words :
       {"", "left", "left up", "left up up", "left right ahead", "left up ahead ", "left  up ahead",
        "Left up ahead", "left up ahead back", "y up"})
    EXPECT_THAT(read_axes(words), FailsWith(ErrorCode::Malformed)) << words;
}

TEST(Hello, MistakesAreNamed) {
  const auto refused = [](const Json& hello, const std::string& context, const std::string& says) {
    const auto read = read_push_message(hello.dump(), nullptr);
    ASSERT_FALSE(read) << hello;
    EXPECT_EQ(read.error().context, context) << hello;
    EXPECT_THAT(read.error().message, HasSubstr(says)) << hello;
  };
  refused(with(kHelloMessage, "layout", "body_27"), "layout", "azure_kinect_32");
  refused(with(kHelloMessage, "layout", 25), "layout", "string");
  refused(with(kHelloMessage, "name", ""), "name", "1 to 64");
  refused(with(kHelloMessage, "name", "caf\u00e9"), "name", "1 to 64");
  refused(with(kHelloMessage, "name", std::string(65, 'x')), "name", "1 to 64");
  refused(with(kHelloMessage, "version", 2), "version", "version 1");
  refused(with(kHelloMessage, "axes", "x y z"), "axes", "right down ahead");
  refused(with(kHelloMessage, "floor", {0, -1, 0, 1.5}), "floor", "pointing up");
  refused(with(kHelloMessage, "floor", {0, 1, 0}), "floor", "4 numbers");
  refused(with(kHelloMessage, "floor", {0, 1, 0, 1600}), "floor[3]", "is it in millimetres?");
  refused(with(kHelloMessage, "trackedFrom", 60), "trackedFrom", "0 to 1");
  refused(with(kHelloMessage, "intrinsics", 900), "intrinsics", "fx");
  const Json half{{"width", 640}, {"height", 480}, {"fx", 500}, {"cx", 320}, {"cy", 240}};
  refused(with(kHelloMessage, "intrinsics", half), "intrinsics.fy", "missing");
  refused(with(kHelloMessage, "intrinsics", with(with(half, "fy", 500), "distortion", {0.1})),
          "intrinsics.distortion", "5 numbers");
  refused(with(kHelloMessage, "intrinsics", with(with(half, "fx", 3.67), "fy", 3.67)),
          "intrinsics.fx", "is it in millimetres?");
  refused(with(kHelloMessage, "intrinsics", with(with(half, "fy", 500), "model", "barrel")),
          "intrinsics.model", "fisheye");
}

TEST(PushedFrame, BringsPointsIntoSensorSpace) {
  const Json hello = with(kHelloMessage, "axes", "right down ahead");
  const auto frame = read_frame(
      frame_of("points", landmarks({{5, {0.2, -0.4, 2.5, 0.9}}, {6, {-0.2, -0.4, 2.5, 0.3}}})),
      hello);
  ASSERT_THAT(frame, IsOk());
  EXPECT_EQ(to_unix_ns(frame->captured), 1795246200250000000);
  ASSERT_EQ(frame->bodies.size(), 1U);
  EXPECT_EQ(frame->bodies[0].id.value, 7U);
  EXPECT_EQ(frame->bodies[0].captured, frame->captured);
  const Joint& left = joint_of(frame, JointId::ShoulderLeft);
  EXPECT_THAT(left.position, VectorNear(Eigen::Vector3d(-0.2, 0.4, 2.5), 1e-12));
  EXPECT_EQ(left.state, JointState::Tracked);
  EXPECT_EQ(left.measurement, Measurement::Point);
  EXPECT_EQ(joint_of(frame, JointId::ShoulderRight).state, JointState::Inferred);
  EXPECT_EQ(joint_of(frame, JointId::Head).state, JointState::NotTracked);
}

TEST(PushedFrame, TakesStatesCovariancesAndNamesOfLandmarks) {
  const Json named{{"left_hip",
                    {{"at", {0.1, 0.0, 3.0}},
                     {"state", "Inferred"},
                     {"covariance", {0.01, 0.002, 0, 0.01, 0, 0.04}}}},
                   {"right_hip", nullptr}};
  const auto frame =
      read_frame(frame_of("points", named), with(kHelloMessage, "axes", "right down ahead"));
  ASSERT_THAT(frame, IsOk());
  const Joint& hip = joint_of(frame, JointId::HipLeft);
  EXPECT_EQ(hip.state, JointState::Inferred);
  ASSERT_TRUE(hip.covariance.known());
  EXPECT_NEAR(hip.covariance.matrix()(2, 2), 0.04, 1e-7);
  EXPECT_NEAR(hip.covariance.matrix()(0, 1), 0.002, 1e-7) << "x and y both change their sign";
}

TEST(PushedFrame, PixelsBecomeRaysAndNothingInventsDepth) {
  const Json camera{{"width", 1280}, {"height", 720}, {"fx", 900},
                    {"fy", 900},     {"cx", 640},     {"cy", 360}};
  const Json hello = with(with(kHelloMessage, "intrinsics", camera), "pixelSigma", 3);
  const auto frame =
      read_frame(frame_of("pixels", landmarks({{9, {640 + 900, 360, 0.8}},
                                               {10, {{"at", {640, 360 - 900}}, {"sigma", 9}}}})),
                 hello);
  ASSERT_THAT(frame, IsOk());
  const Joint& left = joint_of(frame, JointId::WristLeft);
  EXPECT_TRUE(left.bears());
  EXPECT_FALSE(left.seen());
  const double half = std::sqrt(0.5);
  EXPECT_THAT(left.position, VectorNear(Eigen::Vector3d(-half, 0, half), 1e-9)) << "right is -x";
  const Joint& right = joint_of(frame, JointId::WristRight);
  EXPECT_THAT(right.position, VectorNear(Eigen::Vector3d(0, half, half), 1e-9)) << "up is +y";
  EXPECT_NEAR(left.covariance.matrix()(1, 1), std::pow(3.0 / 900 * half, 2), 1e-9);
  EXPECT_NEAR(right.covariance.matrix()(0, 0), std::pow(9.0 / 900 * half, 2), 1e-8);
}

TEST(PushedFrame, PixelsOfAFisheyeFollowItsAngles) {
  const double quarter = std::numbers::pi / 4.0;
  Json camera{{"width", 1280}, {"height", 720}, {"fx", 400},         {"fy", 400},
              {"cx", 640},     {"cy", 360},     {"model", "fisheye"}};
  const auto pixels = frame_of("pixels", landmarks({{9, {640 + 400 * quarter, 360, 0.8}}}));
  const auto frame = read_frame(pixels, with(kHelloMessage, "intrinsics", camera));
  ASSERT_THAT(frame, IsOk());
  const double half = std::sqrt(0.5);
  EXPECT_THAT(joint_of(frame, JointId::WristLeft).position,
              VectorNear(Eigen::Vector3d(-half, 0, half), 1e-9))
      << "a pixel at f * 45 degrees";
}

TEST(PushedFrame, AnUncertainFocalLengthIsInEachRayAndNotLessInTheMeanOfTwo) {
  const Json camera{{"width", 1280}, {"height", 720}, {"fx", 900},
                    {"fy", 900},     {"cx", 640},     {"cy", 360}};
  const Json sure = with(with(kHelloMessage, "intrinsics", camera), "pixelSigma", 3);
  const Json aside{640 + 900, 360, 0.8};
  const Json frame = frame_of("pixels", landmarks({{9, aside}, {11, aside}, {12, aside}}));
  const auto variance = [&](const Json& hello, JointId joint) {
    return joint_of(read_frame(frame, hello), joint).covariance.matrix().trace();
  };
  const Json unsure = with(sure, "focalSigma", 0.1);
  const double angle = 0.1 * 0.5;  // sin a cos a of 45 degrees
  for (const JointId joint : {JointId::WristLeft, JointId::SpineBase}) {
    EXPECT_NEAR(variance(unsure, joint) - variance(sure, joint), angle * angle, 1e-8);
  }
}

TEST(PushedFrame, MayBeEmptyAndLeavesOutBodiesWithoutJoints) {
  EXPECT_TRUE(read_frame({{"type", "frame"}, {"captured", kTime}, {"bodies", Json::array()}})
                  ->bodies.empty());
  EXPECT_TRUE(read_frame(frame_of("points", landmarks({})))->bodies.empty());
}

TEST(PushedFrame, MistakesAreNamedWithTheirPlace) {
  const Json fine = frame_of("points", landmarks({{5, {0, 0, 2}}}));
  expect_refused(with(fine, "captured", "yesterday"), "captured", "nanoseconds since 1970");
  expect_refused(with(fine, "captured", 12345), "captured", "nanoseconds since 1970");
  expect_refused(with(fine, "captured", -1795246200250000000), "captured",
                 "nanoseconds since 1970");
  expect_refused(with(fine, "captured", 1.7952462e18), "captured", "a whole number");
  expect_refused(with(fine, "sequence", "-1"), "sequence", "whole number");
  expect_refused(with(fine, "bodies", nullptr), "bodies", "array");
  expect_refused(with(fine, "bodies", {5}), "bodies[0]", "object");
  expect_refused(with(fine, "bodies", {{{"points", landmarks({})}}}), "bodies[0].id", "missing");
  expect_refused(with(fine, "bodies", {{{"id", 1}}}), "bodies[0]", "either");
  expect_refused(with(fine, "bodies", {fine["bodies"][0], fine["bodies"][0]}), "bodies[1].id",
                 "two bodies");
  expect_refused(frame_of("points", Json::array({nullptr})), "bodies[0].points", "17 landmarks");
  expect_refused(frame_of("points", {{"tail", nullptr}}), "bodies[0].points.tail", "left_shoulder");
  expect_refused(frame_of("points", landmarks({{3, {1, 2}}})), "bodies[0].points[3]", "x, y, z");
  expect_refused(frame_of("points", landmarks({{3, {1, "2", 3}}})), "bodies[0].points[3][1]",
                 "number");
  expect_refused(frame_of("points", landmarks({{3, {1, 2, 2e4}}})), "bodies[0].points[3][2]",
                 "10000");
  expect_refused(frame_of("points", landmarks({{3, {1, 2, 3, 90}}})), "bodies[0].points[3][3]",
                 "0 to 1");
  expect_refused(frame_of("points", landmarks({{3, {{"at", {1, 2, 3}}, {"state", "seen"}}}})),
                 "bodies[0].points[3].state", "Inferred");
  expect_refused(
      frame_of("points",
               landmarks({{3, {{"at", {1, 2, 3}}, {"covariance", {-1, 0, 0, 1, 0, 1}}}}})),
      "bodies[0].points[3].covariance", "negative");
  expect_refused(frame_of("pixels", landmarks({{3, {1, 2}}})), "bodies[0].pixels", "intrinsics");
}

TEST(PushedFrame, ABodyInMillimetresIsRefusedAndAWrongPointIsNot) {
  expect_refused(frame_of("points", landmarks({{5, {300, 100, 2500}}, {6, {-100, 100, 2400}}})),
                 "bodies[0].points", "are these millimetres?");
  EXPECT_THAT(read_frame(frame_of("points", landmarks({{5, {0, 0, 100}}}))), IsOk());
  EXPECT_THAT(read_frame(frame_of("points", landmarks({{5, {0, 0, 2500}}, {6, {0, 0, 2.4}}}))),
              IsOk());
  EXPECT_THAT(read_frame(frame_of("points", landmarks({}))), IsOk()) << "nothing was seen";
}

TEST(PushedFrame, PointsExactlyAtTheSensorAreNotSeenAndCounted) {
  const Json lost{0, 0, 0};
  const auto read =
      read_frame(frame_of("points", landmarks({{5, {0, 0, 2}}, {9, lost}, {10, {0, 0, 0, 0.9}}})));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->zeros, 2u);
  EXPECT_TRUE(joint_of(read, JointId::ShoulderLeft).seen());
  EXPECT_FALSE(joint_of(read, JointId::WristLeft).given());
}

TEST(PushedFrame, NanInEverySpellingIsNotSeen) {
  const Hello hello = hello_of(kHelloMessage);
  for (const char* word : {"NaN", "-nan(ind)", "nan", "Infinity", "None"}) {
    std::string text = frame_of("points", landmarks({{5, {0, 0, 2}}, {9, {1, 7777, 3}}})).dump();
    text.replace(text.find("7777"), 4, word);
    const auto read = read_push_message(text, &hello);
    ASSERT_TRUE(read) << word << ' ' << to_string(read.error());
    const auto& body = std::get<PushedFrame>(*read).bodies.at(0);
    EXPECT_FALSE(body.skeleton[JointId::WristLeft].given());
    EXPECT_TRUE(body.skeleton[JointId::ShoulderLeft].seen());
  }
}

TEST(PushedFrame, NormalisedPixelsAreRefusedAndThoseOutsideThePictureNoted) {
  const Json camera{{"width", 1280}, {"height", 720}, {"fx", 900},
                    {"fy", 900},     {"cx", 640},     {"cy", 360}};
  const Json hello = with(kHelloMessage, "intrinsics", camera);
  const auto three = [](const Json& at) {
    return frame_of("pixels", landmarks({{5, at}, {6, at}, {11, {{"at", at}}}}));
  };
  expect_refused(three({0.5, 1.1}), "bodies[0].pixels", "Multiply them by width and height", hello);
  EXPECT_EQ(read_frame(three({640, 360}), hello)->outside_picture, false);
  EXPECT_EQ(read_frame(three({5000, 360}), hello)->outside_picture, true);
  EXPECT_EQ(read_frame(three({640, -40}), hello)->outside_picture, true);
  EXPECT_EQ(read_frame(frame_of("pixels", landmarks({{5, {5000, 1}}})), hello)->outside_picture,
            std::nullopt)
      << "one landmark says little";
}

TEST(PushedFrame, TooManyBodiesAreRefused) {
  Json frame{{"type", "frame"}, {"captured", kTime}, {"bodies", Json::array()}};
  for (std::size_t i = 0; i <= kMaxBodies; ++i)
    frame["bodies"].push_back({{"id", i}, {"points", landmarks({})}});
  expect_refused(frame, "bodies", "64");
}

TEST(PushedFrame, NeedsAHelloBefore) {
  const auto read = read_push_message(frame_of("points", landmarks({})).dump(), nullptr);
  ASSERT_THAT(read, FailsWith(ErrorCode::Conflict));
  EXPECT_THAT(read.error().message, HasSubstr("hello"));
}

TEST(ClockAnswer, HasThreeStamps) {
  const Json answer{
      {"type", "clock"}, {"sent", kTime}, {"received", 1795246200250000001}, {"answered", kTime}};
  const auto read = read_push_message(answer.dump(), nullptr);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(to_unix_ns(std::get<ClockAnswer>(*read).received), 1795246200250000001);
  Json half = answer;
  half.erase("answered");
  EXPECT_EQ(read_push_message(half.dump(), nullptr).error().context, "answered");
}

TEST(PushMessage, GarbageIsRefusedWithAReason) {
  const Hello hello = hello_of(kHelloMessage);
  for (const std::string garbage :
       {"", "x", "[]", "5", "null", "{\"type\":5}", "{\"type\":\"image\"}", "{\"type\":\"frame\"",
        "\xff\xfe", "{\"type\":\"frame\",\"type\":\"frame\"}", "GET /frame HTTP/1.1"}) {
    const auto read = read_push_message(garbage, &hello);
    ASSERT_FALSE(read) << garbage;
    EXPECT_NE(read.error().message, "") << garbage;
  }
  EXPECT_THAT(read_push_message(std::string(100, '['), &hello), FailsWith(ErrorCode::TooLarge));
}

}  // namespace
}  // namespace chorus::bridge
