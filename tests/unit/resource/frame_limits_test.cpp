// The largest and strangest frames that can be written are read back; digits agree with those of
// printf.
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/resource/clock_resource.h"
#include "common/resource/decimal_reader.h"
#include "common/resource/fixed_point.h"
#include "common/resource/floor_plane_resource.h"
#include "common/resource/frame_parts.h"
#include "common/resource/frame_resource.h"
#include "common/resource/pen.h"
#include "tests/unit/resource/frames.h"

namespace chorus::resource {
namespace {

TEST(FrameLimits, TheFullestFrameIsReadBackInEveryFormat) {
  FrameResource frame = random_frame(11, {kMaxBodies, true});
  frame.sensors.clear();
  for (int i = 0; i < 64; ++i) frame.sensors.push_back("sensor-" + std::to_string(i));
  for (BodyResource& body : frame.bodies) {
    for (JointResource& joint : body.joints) {
      joint.state = JointState::Tracked;
      joint.position = {-9999.9999, 9999.9999, -9999.9999};
      joint.orientation = {-0.5, -0.5, -0.5, -0.5};
      joint.variance = 9999.99999999;
      joint.contributors = ~std::uint64_t{0} >> 60U;
      ShareTally tally;
      for (std::size_t i = 0; i < 4; ++i) tally.add(std::uint64_t{1} << i, 1.0);
      joint.shares = tally.shares();
      joint.age.reset();
    }
  }
  for (const Format format : {Format::Turtle, Format::Json, Format::JsonLd}) {
    const auto back = read_frame(write(frame, format), format);
    ASSERT_TRUE(back) << media_type(format) << ": " << to_string(back.error());
    EXPECT_EQ(difference(frame, *back), "") << media_type(format);
  }
}

TEST(FrameLimits, TheExtremesOfEveryNumberSurvive) {
  FrameResource frame = random_frame(12, {1, true});
  frame.sequence = std::numeric_limits<std::uint64_t>::max();
  frame.captured = from_unix_ns(7'258'118'399'999'999'999);  // the end of 2199
  frame.bodies[0].id = std::numeric_limits<std::uint64_t>::max();
  frame.bodies[0].captured = from_unix_ns(1);
  for (const Format format : kFormats) {
    const auto back = read_frame(write(frame, format), format);
    ASSERT_TRUE(back) << media_type(format) << ": " << to_string(back.error());
    EXPECT_EQ(back->sequence, frame.sequence) << media_type(format);
    EXPECT_EQ(back->captured, frame.captured);
    EXPECT_EQ(back->bodies[0].id, frame.bodies[0].id);
    EXPECT_EQ(back->bodies[0].captured, frame.bodies[0].captured);
  }
}

TEST(FrameLimits, ASourceWithAwkwardLettersIsWrittenAndCannotBreakOut) {
  FrameResource frame = random_frame(13, {1, false});
  for (const char* source : {"a\"b", "a\\", "a\nb", "\xFF", "<b>", "' ;", "\x01"}) {
    frame.source = source;
    for (const Format format : kFormats) {
      const auto back = read_frame(write(frame, format), format);
      ASSERT_FALSE(back) << source;  // no sensor may have this name
      EXPECT_NE(back.error().context.find("ch:source"), std::string::npos)
          << media_type(format) << ": " << to_string(back.error());
    }
  }
}

TEST(Quoted, EscapesWhatTurtleAndJsonBothNeed) {
  EXPECT_EQ(in_quotes("plain"), "\"plain\"");
  EXPECT_EQ(in_quotes("a\"b\\c"), "\"a\\\"b\\\\c\"");
  EXPECT_EQ(in_quotes("\n\t\x1F"), "\"\\u000A\\u0009\\u001F\"");
  EXPECT_EQ(in_quotes("\xC3\xA4\xFF"), "\"\xC3\xA4\xEF\xBF\xBD\"");
  EXPECT_EQ(in_quotes(""), "\"\"");
}

TEST(Pen, GrowsAsItIsAskedTo) {
  Pen pen(4);
  for (int i = 0; i < 1000; ++i) {
    pen.need(40);
    pen.put("x=");
    pen.put_integer(i);
    pen.put("");
    pen.put_decimal<4>(-0.5);
  }
  const std::string text = pen.take();
  EXPECT_TRUE(text.starts_with("x=0-0.5000x=1-0.5000"));
  EXPECT_TRUE(text.ends_with("x=999-0.5000"));
  EXPECT_EQ(text.size(), 1000U * 9 + 10 + 90 * 2 + 900 * 3);
}

TEST(FixedPoint, AgreesWithPrintfAtEveryNumberOfDecimals) {
  std::mt19937 random(17);
  for (int decimals = 1; decimals <= 8; ++decimals) {
    for (int i = 0; i < 2000; ++i) {
      const double reach = std::pow(10.0, i % 7);
      const double value = std::uniform_real_distribution<double>(-reach, reach)(random);
      char text[64];
      std::snprintf(text, sizeof text, "%.*f", decimals, value);
      // llrint rounds the product, printf the value: in a tie the last digit may differ.
      EXPECT_NEAR(*read_decimal(*fixed(value, decimals)), std::strtod(text, nullptr),
                  1.01 * std::pow(10.0, -decimals));
      EXPECT_EQ(fixed(value, decimals)->size() - (fixed(value, decimals)->front() == '-' ? 1 : 0),
                std::string(text).size() - (text[0] == '-' ? 1 : 0));
    }
  }
}

TEST(FloorPlaneResource, SaysWhichSpaceItIsIn) {
  const FloorPlane floor{Eigen::Vector3d::UnitY(), 1.5};
  EXPECT_NE(write(floor_plane_node(floor, SpaceKind::World), Format::Turtle).find("ch:WorldSpace"),
            std::string::npos);
  EXPECT_NE(
      write(floor_plane_node(floor, SpaceKind::Sensor), Format::Turtle).find("ch:SensorSpace"),
      std::string::npos);
}

}  // namespace
}  // namespace chorus::resource
