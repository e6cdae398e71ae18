#include "services/sensor/device/camera/runner_wire.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/sensor/pixel_ray.h"

namespace chorus::camera {
namespace {

using ::testing::HasSubstr;

const Timestamp kNoon = from_unix_ns(1'795'246'200'250'000'000);
const Question kQuestion{42, kNoon, {256, 144}};

std::string answer(const std::string& bodies, const std::string& sequence = "42",
                   const std::string& captured = "1795246200250000000") {
  return R"({"type": "frame", "sequence": )" + sequence + R"(, "captured": ")" + captured +
         R"(", "milliseconds": 31.5, "bodies": )" + bodies + "}";
}

bridge::Hello hello() {
  auto read =
      read_runner_hello(R"({"type": "hello", "version": 1, "name": "n", "layout": "coco_17"})");
  EXPECT_TRUE(read);
  read->hello.camera = Intrinsics{256, 144, 200, 200, 128, 72, {}};
  return read->hello;
}

TEST(RunnerWire, TheHeaderIsAsSpecified) {
  EXPECT_EQ(
      image_header(kQuestion),
      R"({"type":"image","sequence":42,"captured":"1795246200250000000","width":256,"height":144,)"
      R"("format":"rgb24","bytes":110592})"
      "\n");
}

TEST(RunnerWire, AHelloSaysHowLargeImagesMayBe) {
  const auto small = read_runner_hello(
      R"({"type": "hello", "version": 1, "name": "n", "layout": "coco_17", "pixelSigma": 2,
          "intrinsics": {"width": 9, "height": 9, "fx": 9, "fy": 9, "cx": 9, "cy": 9},
          "image": {"maxSide": 256}})");
  ASSERT_TRUE(small);
  EXPECT_EQ(small->max_side, 256);
  EXPECT_EQ(small->hello.pixel_sigma, 2.0);
  EXPECT_FALSE(small->hello.camera);
  const auto silent = read_runner_hello(R"({"type": "hello", "name": "n", "layout": "coco_17"})");
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->max_side, 640);
  EXPECT_EQ(silent->hello.pixel_sigma, 6.4);
}

TEST(RunnerWire, WhatIsNoHelloIsRefused) {
  const auto refusal = [](const char* line) {
    const auto read = read_runner_hello(line);
    return read ? "" : to_string(read.error());
  };
  EXPECT_THAT(refusal("loading models ..."), HasSubstr("the first line is \"loading models ...\""));
  EXPECT_THAT(refusal(R"({"type": "hello", "name": "n", "layout": "x"})"), HasSubstr("coco_17"));
  EXPECT_THAT(
      refusal(R"({"type": "clock", "sent": "1795246200250000000", "received": "1795246200250000000",
                          "answered": "1795246200250000000"})"),
      HasSubstr("must be \"hello\""));
  EXPECT_THAT(
      refusal(R"({"type": "hello", "name": "n", "layout": "coco_17", "image": {"maxSide": 5}})"),
      HasSubstr("image.maxSide"));
}

TEST(RunnerWire, PixelsBecomeRays) {
  std::string pixels = R"([{"id": 3, "pixels": [[178, 72, 0.9])";
  for (int i = 1; i < 17; ++i) pixels += ",null";
  const auto frame = read_runner_answer(answer(pixels + "]}]"), kQuestion, hello());
  ASSERT_TRUE(frame) << to_string(frame.error());
  ASSERT_EQ(frame->bodies.size(), 1u);
  const BodyFrame& body = frame->bodies.front();
  EXPECT_EQ(body.id, BodyId{3});
  EXPECT_EQ(body.captured, kNoon);
  const Joint& head = body.skeleton[JointId::Head];
  EXPECT_TRUE(head.bears());
  // The pixel is a quarter of the focal length to the right of the centre; the sensor's x points
  // left.
  EXPECT_NEAR((head.position - Eigen::Vector3d(-0.25, 0, 1).normalized()).norm(), 0.0, 1e-9);
  EXPECT_TRUE(head.covariance.known());
}

TEST(RunnerWire, AWorldBesideThePixelsIsTheShape) {
  std::string body = R"([{"id": 3, "pixels": [[178, 72])";
  for (int i = 1; i < 17; ++i) body += ",null";
  body += R"(], "world": [[0.1, -0.6, -0.2])";
  for (int i = 1; i < 17; ++i) body += ",null";
  const auto frame = read_runner_answer(answer(body + "]}]"), kQuestion, hello());
  ASSERT_TRUE(frame) << to_string(frame.error());
  ASSERT_EQ(frame->shapes.size(), 1u);
  EXPECT_TRUE(frame->bodies.front().skeleton[JointId::Head].bears());
  const Joint& head = frame->shapes.front()[JointId::Head];
  EXPECT_TRUE(head.seen());
  EXPECT_EQ(head.position, Eigen::Vector3d(-0.1, 0.6, -0.2));
}

TEST(RunnerWire, WhatIsNoAnswerIsShownAsTheRunnersOwn) {
  const auto printed = read_runner_answer("debug: found 1 person", kQuestion, hello());
  ASSERT_FALSE(printed);
  EXPECT_EQ(printed.error().context, "the runner's answer");
  EXPECT_THAT(printed.error().message, HasSubstr("begins with \"debug: found 1 person\""));
  EXPECT_THAT(printed.error().message, HasSubstr("print everything else to the standard error"));
  const auto nan =
      read_runner_answer(answer(R"([{"id": 1, "pixels": [[NaN, 1]]}])"), kQuestion, hello());
  ASSERT_FALSE(nan);
  EXPECT_THAT(nan.error().message, HasSubstr("an array of 17 landmarks"));
  EXPECT_THAT(nan.error().message, ::testing::Not(HasSubstr("standard error")));
}

TEST(RunnerWire, AnAnswerBelongsToItsImage) {
  EXPECT_TRUE(read_runner_answer(answer("[]"), kQuestion, hello()));
  for (const std::string& wrong : {answer("[]", "41"), answer("[]", "42", "1795246200250000001")}) {
    const auto read = read_runner_answer(wrong, kQuestion, hello());
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("must be 42"));
  }
  EXPECT_FALSE(read_runner_answer(R"({"type": "hello", "name": "n", "layout": "coco_17"})",
                                  kQuestion, hello()));
}

TEST(RunnerWire, MasksAreAskedForAndRead) {
  Question question = kQuestion;
  question.mask = true;
  EXPECT_THAT(image_header(question), HasSubstr(R"(,"wants":["mask"]})"));
  const auto able = read_runner_hello(
      R"({"type": "hello", "name": "n", "layout": "coco_17", "gives": ["masks"]})");
  ASSERT_TRUE(able);
  EXPECT_TRUE(able->masks);
  EXPECT_FALSE(read_runner_hello(R"({"type": "hello", "name": "n", "layout": "coco_17"})")->masks);
  const auto mask = read_runner_mask(R"({"mask": {"width": 4, "height": 2, "runs": [1, 2, 5]}})");
  ASSERT_TRUE(mask && *mask);
  EXPECT_EQ((*mask)->size, (Size{4, 2}));
  EXPECT_EQ((*mask)->cells, (std::vector<std::uint8_t>{0, 255, 255, 0, 0, 0, 0, 0}));
  const auto none = read_runner_mask(R"({"bodies": []})");
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
}

TEST(RunnerWire, AMaskThatIsNoneIsRefused) {
  for (const char* mask :
       {R"(3)", R"({})", R"({"width": 4, "height": 2})", R"({"width": 4, "height": 2, "runs": 8})",
        R"({"width": 4, "height": 2, "runs": [1, 2]})",
        R"({"width": 4, "height": 2, "runs": [1, 2, 6]})",
        R"({"width": 4, "height": 2, "runs": [18446744073709551615, 9]})",
        R"({"width": 4, "height": 2, "runs": [-1, 9]})", R"({"width": 0, "height": 2, "runs": []})",
        R"({"width": 99999, "height": 99999, "runs": [9999800001]})"})
    EXPECT_FALSE(read_runner_mask(std::string(R"({"mask": )") + mask + "}")) << mask;
}

}  // namespace
}  // namespace chorus::camera
