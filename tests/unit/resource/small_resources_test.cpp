#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "common/resource/clock_resource.h"
#include "common/resource/flat_reader.h"
#include "common/resource/floor_plane_resource.h"
#include "common/resource/image_resource.h"

namespace chorus::resource {
namespace {

TEST(FloorPlaneResource, ReadsBackFromEveryFormat) {
  const FloorPlane floor = *make_plane(0.01, 0.98, 0.2, 1.25);
  const Node node = floor_plane_node(floor, SpaceKind::Sensor);
  EXPECT_TRUE(undeclared_terms(node).empty());
  for (const Format format : kFormats) {
    const auto back = read_floor_plane(write(node, format, {"floor-plane"}), format);
    ASSERT_TRUE(back) << media_type(format) << ": " << to_string(back.error());
    EXPECT_NEAR((back->normal - floor.normal).norm(), 0.0, 2e-6);
    EXPECT_NEAR(back->offset, floor.offset, 2e-6);
  }
}

TEST(FloorPlaneResource, RefusesWhatIsNoFloor) {
  const auto read = [](const char* json) { return read_floor_plane(json, Format::Json); };
  EXPECT_FALSE(read(R"({"@type":"FloorPlane","normalX":0,"normalY":0,"normalZ":0,"offset":1})"));
  EXPECT_FALSE(read(R"({"@type":"FloorPlane","normalX":0,"normalY":1,"normalZ":0})"));
  EXPECT_FALSE(
      read(R"({"@type":"FloorPlane","normalX":0,"normalY":"NaN","normalZ":0,"offset":1})"));
  EXPECT_FALSE(read(R"({"@type":"FloorPlane","normalX":0,"normalY":1,"normalZ":0,"offset":1e9})"));
  EXPECT_FALSE(read(R"({"@type":"Clock","normalX":0,"normalY":1,"normalZ":0,"offset":1})"));
  EXPECT_FALSE(read("[]"));
  EXPECT_TRUE(read(R"({"@type":"FloorPlane","normalX":0,"normalY":2,"normalZ":0,"offset":2})"));
  const char* const twice =
      "@prefix ch: <https://w3id.org/chorus-tracking/ns#> . <> a ch:FloorPlane ; ch:normalX 0 ; "
      "ch:normalY 1, 2 ; ch:normalZ 0 ; ch:offset 1 .";
  const auto refused = read_floor_plane(twice, Format::Turtle);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().context, "ch:normalY");
}

TEST(ClockResource, SaysTheTimeAndWhatTheKernelKnowsOfIt) {
  const ClockState clock{from_unix_ns(1'795'246'200'250'000'001),
                         {true, Duration(-1500), Duration(2'000'000), Duration(3000), -12.5}};
  const Node node = clock_node(clock);
  EXPECT_TRUE(undeclared_terms(node).empty());
  for (const Format format : kFormats) {
    const auto back = read_properties(write(node, format, {"clock"}), format, "Clock");
    ASSERT_TRUE(back) << media_type(format) << ": " << to_string(back.error());
    EXPECT_EQ(back->at("nowNanoseconds"), "1795246200250000001") << media_type(format);
    EXPECT_EQ(back->at("synchronised"), "true");
    EXPECT_EQ(back->at("offsetNanoseconds"), "-1500");
    EXPECT_EQ(back->at("maxErrorNanoseconds"), "2000000");
    EXPECT_EQ(back->at("estimatedErrorNanoseconds"), "3000");
    EXPECT_EQ(number_of(*back, "frequencyPpm").value_or(0.0), -12.5);
  }
}

TEST(ImageResource, SaysHowToMeasureInIt) {
  CameraImage image{from_unix_ns(1), {}, "image/png", ""};
  const Node depth = image_node(image, "images/depth");
  EXPECT_TRUE(undeclared_terms(depth).empty());
  const std::string turtle = write(depth, Format::Turtle, {"images/"});
  EXPECT_NE(turtle.find("ch:fx 366.300"), std::string::npos) << turtle;
  EXPECT_NE(turtle.find("ch:metresPerUnit 0.0010"), std::string::npos) << turtle;
  image.media_type = "image/jpeg";
  EXPECT_EQ(write(image_node(image, "c"), Format::Json).find("metresPerUnit"), std::string::npos);
}

TEST(FloorPlaneResource, TakesFloorsAsFarAsBodiesMayBe) {
  const auto read = [](double offset) {
    return read_floor_plane(
        R"({"@type":"FloorPlane","normalX":0,"normalY":1,"normalZ":0,"offset":)" +
            std::to_string(offset) + "}",
        Format::Json);
  };
  EXPECT_TRUE(read(-10'000));
  const auto far = read(10'000.1);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().context, "ch:offset");
  EXPECT_EQ(far.error().message, "is beyond anything a floor can be");
}

TEST(FloorPlaneResource, KeepsThePlaneAndNotItsScale) {
  const auto floor = read_floor_plane(
      R"({"@type":"FloorPlane","normalX":0,"normalY":2,"normalZ":0,"offset":3})", Format::Json);
  ASSERT_TRUE(floor);
  EXPECT_EQ(floor->normal, Eigen::Vector3d::UnitY());
  EXPECT_EQ(floor->offset, 1.5);
}

TEST(ImageResource, HasTheLensInPixelsAndTheDistortionInItsOrder) {
  CameraImage image{from_unix_ns(1'795'246'200'250'000'001), {}, "image/jpeg", ""};
  image.intrinsics = {1280, 720, 900.1234, 901.5, 640.25, 359.75, {0.1, -0.2, 0.001, -0.002, 0.03}};
  const auto json = nlohmann::json::parse(write(image_node(image, "images/color"), Format::Json));
  EXPECT_EQ(json.at("@id"), "images/color");
  EXPECT_EQ(json.at("mediaType"), "image/jpeg");
  EXPECT_EQ(json.at("width"), 1280);
  EXPECT_EQ(json.at("height"), 720);
  EXPECT_EQ(json.at("fx"), 900.123);
  EXPECT_EQ(json.at("fy"), 901.5);
  EXPECT_EQ(json.at("cx"), 640.25);
  EXPECT_EQ(json.at("cy"), 359.75);
  EXPECT_EQ(json.at("distortion"), nlohmann::json({0.1, -0.2, 0.001, -0.002, 0.03}));
  EXPECT_EQ(json.at("captured"), "2026-11-21T07:30:00.250000001Z");
  EXPECT_EQ(json.at("capturedNanoseconds"), "1795246200250000001");
  EXPECT_FALSE(json.contains("lensModel")) << "Brown's";
  image.intrinsics.model = LensModel::Fisheye;
  const auto wide = nlohmann::json::parse(write(image_node(image, "images/color"), Format::Json));
  EXPECT_EQ(wide.at("lensModel"), "fisheye");
}

TEST(ClockResource, NeedsNoNumbersThatJavaScriptRounds) {
  const ClockState clock{from_unix_ns(1'795'246'200'250'000'001), {}};
  const auto json = nlohmann::json::parse(write(clock_node(clock), Format::Json));
  EXPECT_EQ(json.at("nowNanoseconds"), "1795246200250000001");
  EXPECT_EQ(json.at("now"), "2026-11-21T07:30:00.250000001Z");
  EXPECT_EQ(json.at("synchronised"), false);
}

}  // namespace
}  // namespace chorus::resource
