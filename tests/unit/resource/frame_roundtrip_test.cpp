#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "common/rdf/turtle_reader.h"
#include "common/rdf/turtle_writer.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_resource.h"
#include "tests/support/graph/isomorphism.h"
#include "tests/unit/resource/frames.h"

namespace chorus::resource {
namespace {

constexpr std::uint64_t kSeeds = 60;

FrameKind kind_of(std::uint64_t seed) { return {seed % 7, seed % 2 == 1}; }

TEST(FrameRoundTrip, EveryFormatKeepsEveryValue) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const FrameResource frame = random_frame(seed, kind_of(seed));
    for (const Format format : kFormats) {
      const std::string text = write(frame, format);
      const auto back = read_frame(text, format);
      ASSERT_TRUE(back) << media_type(format) << ": " << to_string(back.error());
      if (format != Format::NTriples) {  // sets in N-Triples have no order
        EXPECT_EQ(difference(frame, *back), "") << media_type(format) << " seed " << seed;
      }
      EXPECT_EQ(write(*back, format), text) << "write(read(x)) is stable";
    }
  }
}

TEST(FrameRoundTrip, TheParserAndTheTemplateReaderAgree) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const FrameResource frame = random_frame(seed, kind_of(seed));
    const std::string text = write(frame, Format::Turtle);
    const auto fast = read_template(text);
    ASSERT_TRUE(fast) << "the template reader must know our own bytes";
    const auto parsed = read_rdf_frame(text, Format::Turtle);
    ASSERT_TRUE(parsed) << to_string(parsed.error());
    EXPECT_EQ(difference(*fast, *parsed), "");
    EXPECT_EQ(difference(*fast, frame), "");
  }
}

/// A frame whose ids can all be plain JSON numbers; larger ids are written as strings, which the
/// template reader leaves to the parser.
FrameResource json_frame(std::uint64_t seed) {
  FrameResource frame = random_frame(seed, kind_of(seed));
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) frame.bodies[i].id = seed + i;
  return frame;
}

/// Where the template reader accepts a text, the parser reads the same frame.
void expect_the_parser_agrees(const std::string& text) {
  const auto fast = read_json_template(text);
  if (!fast) return;
  const auto parsed = read_json_frame(text);
  ASSERT_TRUE(parsed) << "only the template reader takes " << text;
  EXPECT_EQ(difference(*fast, *parsed), "") << text;
}

TEST(FrameRoundTrip, TheJsonParserAndTheJsonTemplateReaderAgree) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const FrameResource frame = json_frame(seed);
    for (const Place& place : {Place{}, Place{"sensors/s1/frame", "sensors/s1/"}}) {
      const std::string text = write(frame, Format::Json, place);
      const auto fast = read_json_template(text);
      ASSERT_TRUE(fast) << "the template reader must know our own bytes: " << text;
      EXPECT_EQ(difference(*fast, frame), "");
      expect_the_parser_agrees(text);
    }
  }
}

TEST(FrameRoundTrip, RecordingsWhoseJointsHaveNoTypeAreReadByTheTemplateToo) {
  const FrameResource frame = json_frame(9);
  std::string text = write(frame, Format::Json);
  const std::string type = "\"@type\":\"Joint\",";
  for (std::size_t at = text.find(type); at != std::string::npos; at = text.find(type, at))
    text.erase(at, type.size());
  const auto fast = read_json_template(text);
  ASSERT_TRUE(fast);
  EXPECT_EQ(difference(*fast, frame), "");
}

TEST(FrameRoundTrip, TheJsonTemplateReaderTakesNothingTheParserRefuses) {
  constexpr std::string_view kBytes = "0123456789.-+eE\"\\{}[],: aTs\n\x80";
  std::mt19937_64 dice(7);
  const auto pick = [&dice](std::size_t below) { return dice() % below; };
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    std::string text = write(json_frame(seed % kSeeds), Format::Json);
    const std::size_t at = pick(text.size());
    const char byte = kBytes[pick(kBytes.size())];
    if (seed % 3 == 0) text[at] = byte;
    if (seed % 3 == 1) text.insert(at, 1, byte);
    if (seed % 3 == 2) text.erase(at, 1 + pick(3));
    expect_the_parser_agrees(text);
  }
}

TEST(FrameRoundTrip, JsonWrittenByHandNeedsNoType) {
  const std::string text = write(json_frame(2), Format::Json);
  const std::string_view type = ",\"@type\":\"Frame\"";
  std::string without = text;
  without.erase(without.find(type), type.size());
  const auto read = read_frame(without, Format::Json);
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(difference(*read, *read_frame(text, Format::Json)), "");
  std::string other = text;
  other.replace(other.find(type), type.size(), ",\"@type\":\"Floor\"");
  EXPECT_FALSE(read_frame(other, Format::Json));
}

TEST(FrameRoundTrip, WhatOnlyLooksLikeJsonIsLeftToTheParser) {
  const std::string text = write(json_frame(8), Format::Json);
  const auto with = [&text](std::string_view from, std::string_view to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return changed;
  };
  for (const std::string& wrong :
       {with("\"sequence\":", "\"sequence\":0"), with("\"sequence\":", "\"sequence\":-"),
        with("\"x\":", "\"x\":0"), with("\"x\":", "\"x\":."), text + " ", text + "{}",
        with("T", " "), with("\"bodies\":[", "\"bodies\":[,")}) {
    EXPECT_FALSE(read_json_template(wrong)) << wrong.substr(0, 300);
    expect_the_parser_agrees(wrong);
  }
}

TEST(FrameRoundTrip, TheTemplateWritesTheGraphThatSerdWrites) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const FrameResource frame = random_frame(seed, kind_of(seed));
    const rdf::Graph graph = expected_graph(frame);
    const auto serd = rdf::write_graph(graph, {rdf::Syntax::Turtle, {}, {}});
    ASSERT_TRUE(serd) << to_string(serd.error());
    const auto ours = rdf::read_graph(write(frame, Format::Turtle));
    ASSERT_TRUE(ours) << to_string(ours.error());
    EXPECT_EQ(testing::difference(*ours, *rdf::read_graph(*serd)), "");
    const auto read = read_frame(*serd, Format::Turtle);
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_EQ(difference(*read, frame), "") << "another spelling, the same frame";
  }
}

TEST(FrameRoundTrip, NTriplesIsTheTurtleMadeAbsolute) {
  const FrameResource frame = random_frame(3, {3, true});
  const Place place{"frames/42", "", "http://host:8080/"};
  const auto triples =
      rdf::read_graph(write(frame, Format::NTriples, place), {rdf::Syntax::NTriples, {}, {}});
  ASSERT_TRUE(triples) << to_string(triples.error());
  rdf::ReadOptions options;
  options.base = "http://host:8080/frames/42";
  const auto turtle = rdf::read_graph(write(frame, Format::Turtle, place), options);
  EXPECT_EQ(testing::difference(*triples, *turtle), "");
  EXPECT_EQ(turtle->front().subject.value,
            "http://host:8080/frames/" + std::to_string(frame.sequence));
}

TEST(FrameRoundTrip, PlacesChangeNamesAndNothingElse) {
  const FrameResource frame = random_frame(5, {2, true});
  for (const Place& place : {Place{"frames/42"}, Place{"sensors/s1/frame", "sensors/s1/"}}) {
    for (const Format format : kFormats) {
      const auto back = read_frame(write(frame, format, place), format);
      ASSERT_TRUE(back) << to_string(back.error());
      EXPECT_EQ(back->bodies.size(), 2U);
    }
    EXPECT_TRUE(read_template(write(frame, Format::Turtle, place))) << place.path;
  }
  EXPECT_NE(write(frame, Format::Turtle, {"sensors/s1/frame", "sensors/s1/"})
                .find("<../../sensors/s1/frames/" + std::to_string(frame.sequence) + ">"),
            std::string::npos);
}

TEST(FrameWriter, NeverWritesWhatIsNotANumber) {
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 1e300, 10'000.1}) {
    FrameResource frame = random_frame(2, {1, true});
    JointResource& joint = frame.bodies[0].joints[3];
    const Eigen::Quaterniond upright(1, 0, 0, 0);
    joint = {{Eigen::Vector3d(0, bad, 0), upright, JointState::Tracked}, 0.1, 1};
    Eigen::Matrix3d odd = Eigen::Matrix3d::Identity();
    odd(0, 1) = bad;
    frame.bodies[0].joints[5] = {{Eigen::Vector3d(1, 2, 3), upright, JointState::Tracked,
                                  Measurement::Point, Covariance(odd)},
                                 0.1,
                                 1};
    frame.bodies[0].joints[6] = {
        {Eigen::Vector3d(bad, 0, 1), upright, JointState::Tracked, Measurement::Ray}, 0.1, 1};
    frame.bodies[0].joints[4] = {
        {Eigen::Vector3d(1, 2, 3), Eigen::Quaterniond(bad, 0, 0, 0), JointState::Tracked}, bad, 1};
    for (const Format format : kFormats) {
      const auto back = read_frame(write(frame, format), format);
      ASSERT_TRUE(back) << bad << ": " << to_string(back.error());
      EXPECT_EQ(back->bodies[0].joints[3].state, JointState::NotTracked);
      EXPECT_EQ(back->bodies[0].joints[4].state, JointState::Tracked);
      EXPECT_FALSE(back->bodies[0].joints[5].covariance.known());
      EXPECT_EQ(back->bodies[0].joints[6].state, JointState::NotTracked);
    }
    EXPECT_TRUE(rdf::read_graph(write_arvida(frame)));
  }
}

TEST(FrameWriter, NormalisesAQuaternionBeforeItLeaves) {
  FrameResource frame = random_frame(2, {1, false});
  frame.bodies[0].joints[0] = {
      {Eigen::Vector3d(1, 2, 3), Eigen::Quaterniond(2, 0, 0, 0), JointState::Tracked}, {}, 0};
  const auto back = read_frame(write(frame, Format::Turtle), Format::Turtle);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->bodies[0].joints[0].orientation.w(), 1.0);
}

TEST(FrameWriter, NumbersInJsonAreNumbersAndInJsonLdStrings) {
  const FrameResource frame = random_frame(4, {2, true});
  const auto json = nlohmann::json::parse(write(frame, Format::Json));
  const auto linked = nlohmann::json::parse(write(frame, Format::JsonLd));
  EXPECT_EQ(linked.at("@context"), "context.jsonld");
  for (const auto& [name, joint] : json.at("bodies")[0].at("joints").items()) {
    if (joint.at("state") == "NotTracked") continue;
    EXPECT_TRUE(joint.at("x").is_number());
    EXPECT_TRUE(linked.at("bodies")[0].at("joints").at(name).at("x").is_string());
  }
  EXPECT_TRUE(json.at("bodies")[0].at("bodyId").is_number());
  EXPECT_EQ(json.at("bodies")[1].at("bodyId"), "72057594037928018") << "beyond 2^53";
}

TEST(FrameResource, IsASensorFrameOnTheWire) {
  SensorFrame frame;
  frame.sensor = *SensorId::parse("s7");
  frame.sequence = 9;
  frame.captured = from_unix_ns(1'795'246'200'250'000'000);
  BodyFrame body{BodyId{5}, frame.captured, {}};
  body.skeleton[JointId::Head] = {Eigen::Vector3d(1, 2, 3), Eigen::Quaterniond(1, 0, 0, 0),
                                  JointState::Inferred};
  frame.bodies.push_back(body);
  const Timestamp received = from_unix_ns(1'795'246'200'260'000'000);
  const SensorFrame back = to_sensor_frame(to_resource(frame), frame.sensor, received);
  EXPECT_EQ(back.sensor, frame.sensor);
  EXPECT_EQ(back.sequence, 9U);
  EXPECT_EQ(back.captured, frame.captured);
  EXPECT_EQ(back.received, received);
  ASSERT_EQ(back.bodies.size(), 1U);
  EXPECT_EQ(back.bodies[0].id, BodyId{5});
  EXPECT_EQ(back.bodies[0].skeleton[JointId::Head].position.z(), 3.0);
  EXPECT_EQ(back.bodies[0].skeleton[JointId::Head].state, JointState::Inferred);
  EXPECT_FALSE(back.bodies[0].skeleton[JointId::Neck].seen());
}

}  // namespace
}  // namespace chorus::resource
