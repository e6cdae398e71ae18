// One frame written in many ways: what means the same in RDF is read as the same frame.
#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "common/rdf/turtle_reader.h"
#include "common/rdf/turtle_writer.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_resource.h"
#include "tests/unit/resource/frames.h"

namespace chorus::resource {
namespace {

const std::string kNs = "https://w3id.org/chorus-tracking/ns#";

rdf::Graph graph_of(const FrameResource& frame) {
  return rdf::read_graph(write(frame, Format::Turtle)).value();
}

Result<FrameResource> read_graph_as(const rdf::Graph& graph,
                                    rdf::Syntax syntax = rdf::Syntax::Turtle) {
  const std::string base = syntax == rdf::Syntax::NTriples ? "http://h/frame" : "";
  const auto text = rdf::write_graph(graph, {syntax, {}, base});
  return read_frame(text.value(),
                    syntax == rdf::Syntax::Turtle ? Format::Turtle : Format::NTriples);
}

/// Bodies and joints are sets on the wire: sorts them by id for comparison.
FrameResource sorted(FrameResource frame) {
  std::sort(frame.bodies.begin(), frame.bodies.end(),
            [](const BodyResource& a, const BodyResource& b) { return a.id < b.id; });
  return frame;
}

TEST(FrameSpellings, TheOrderOfTheTriplesDoesNotMatter) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const FrameResource frame = random_frame(seed, {3, false});
    rdf::Graph graph = graph_of(frame);
    std::shuffle(graph.begin(), graph.end(), std::mt19937(seed));
    for (const rdf::Syntax syntax : {rdf::Syntax::Turtle, rdf::Syntax::NTriples}) {
      const auto back = read_graph_as(graph, syntax);
      ASSERT_TRUE(back) << seed << ": " << to_string(back.error());
      EXPECT_EQ(difference(sorted(frame), sorted(*back)), "") << seed;
    }
  }
}

TEST(FrameSpellings, TheCellsOfAListMayStandAnywhere) {
  const FrameResource frame = random_frame(2, {2, true});
  rdf::Graph graph = graph_of(frame);
  std::ranges::reverse(std::ranges::stable_partition(graph, [](const rdf::Triple& triple) {
    return triple.subject.kind != rdf::TermKind::Blank;
  }));
  std::ranges::rotate(graph, graph.end() - 20);
  ASSERT_EQ(graph.front().subject.kind, rdf::TermKind::Blank);
  const auto back = read_graph_as(graph, rdf::Syntax::NTriples);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(difference(frame, *back), "");
}

TEST(FrameSpellings, ListsMayNotBeEndless) {
  std::string text = write(random_frame(2, {1, true}), Format::Turtle);
  text += "\n<x> <http://other/list> (";
  for (int i = 0; i < 24'600; ++i) text += " 1";
  const auto back = read_frame(text + ") .\n", Format::Turtle);
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, ErrorCode::TooLarge);
}

TEST(FrameSpellings, SayingATripleTwiceChangesNothing) {
  const FrameResource frame = random_frame(2, {2, true});
  rdf::Graph graph = graph_of(frame);
  const rdf::Graph once = graph;
  graph.insert(graph.end(), once.begin(), once.end());
  const auto back = read_graph_as(graph);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(difference(frame, *back), "");
}

TEST(FrameSpellings, WhatOthersSayOfOurSubjectsIsPassedOver) {
  const FrameResource frame = random_frame(3, {1, false});
  rdf::Graph graph = graph_of(frame);
  const rdf::Term subject = graph.front().subject;
  graph.push_back(
      {rdf::iri("frame"), rdf::iri("http://purl.org/dc/terms/title"), rdf::literal("x")});
  graph.push_back({subject, rdf::iri(rdf::rdf("type")), rdf::iri("http://other/Thing")});
  graph.push_back(
      {rdf::iri("somebody"), rdf::iri(kNs + "sequence"), rdf::literal("99", rdf::xsd("integer"))});
  graph.push_back({subject, rdf::iri(kNs + "newerThanUs"), rdf::literal("x")});
  const auto back = read_graph_as(graph);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(difference(frame, *back), "");
}

TEST(FrameSpellings, NumbersMayBeDoublesFloatsOrIntegers) {
  const FrameResource frame = random_frame(5, {1, false});
  for (const char* type : {"double", "float", "decimal"}) {
    rdf::Graph graph = graph_of(frame);
    for (rdf::Triple& triple : graph) {
      if (triple.object.datatype == rdf::xsd("decimal")) triple.object.datatype = rdf::xsd(type);
    }
    const auto back = read_graph_as(graph);
    ASSERT_TRUE(back) << type << ": " << to_string(back.error());
    EXPECT_EQ(difference(frame, *back), "") << type;
  }
  rdf::Graph textual = graph_of(frame);
  for (rdf::Triple& triple : textual) {
    if (triple.object.datatype == rdf::xsd("decimal")) triple.object.datatype.clear();
  }
  EXPECT_FALSE(read_graph_as(textual)) << "a text is no number";
}

/// The subject of a triple with this predicate and object.
rdf::Term subject_with(const rdf::Graph& graph, const std::string& property,
                       const rdf::Term& object) {
  for (const rdf::Triple& triple : graph) {
    if (triple.predicate.value == property && triple.object == object) return triple.subject;
  }
  ADD_FAILURE() << property << " is said of nothing";
  return {};
}

enum class Of { Frame, Body, Head, Placed };

/// The graph with one more triple about the frame, its body, the head or a joint with a place.
Result<FrameResource> with(Of of, const std::string& property, rdf::Term object) {
  const FrameResource frame = random_frame(8, {1, false});
  rdf::Graph graph = graph_of(frame);
  const std::string type = rdf::rdf("type");
  const auto placed = std::find_if(graph.begin(), graph.end(), [](const rdf::Triple& triple) {
    return triple.predicate.value == kNs + "x";
  });
  const std::map<Of, rdf::Term> subjects{
      {Of::Frame, subject_with(graph, type, rdf::iri(kNs + "Frame"))},
      {Of::Body, subject_with(graph, type, rdf::iri(kNs + "Skeleton"))},
      {Of::Head, subject_with(graph, kNs + "jointName", rdf::literal("Head"))},
      {Of::Placed, placed->subject}};
  const rdf::Term subject = subjects.at(of);
  graph.push_back({subject, rdf::iri(kNs + property), std::move(object)});
  return read_graph_as(graph);
}

TEST(FrameSpellings, ContradictionsAreRefused) {
  EXPECT_FALSE(with(Of::Frame, "sequence", rdf::literal("1234567", rdf::xsd("integer"))));
  EXPECT_FALSE(with(Of::Frame, "source", rdf::literal("another")));
  EXPECT_FALSE(with(Of::Frame, "space", rdf::iri(kNs + "WorldSpace")));
  EXPECT_FALSE(with(Of::Body, "bodyId", rdf::literal("1234567", rdf::xsd("integer"))));
  EXPECT_FALSE(with(Of::Head, "jointName", rdf::literal("Neck")));
  EXPECT_FALSE(with(Of::Placed, "x", rdf::literal("77.5", rdf::xsd("decimal"))));
}

TEST(FrameSpellings, ObjectsOfTheWrongKindAreRefused) {
  EXPECT_FALSE(with(Of::Frame, "body", rdf::literal("skeletons/3")));
  EXPECT_FALSE(with(Of::Frame, "captured", rdf::literal("2026-11-21T07:30:00Z")));
  EXPECT_FALSE(with(Of::Frame, "source", rdf::iri("http://h/s1")));
  EXPECT_FALSE(with(Of::Body, "joint", rdf::literal("Head")));
  EXPECT_FALSE(with(Of::Head, "state", rdf::literal("Tracked")));
  EXPECT_FALSE(with(Of::Head, "state", rdf::iri("http://other/Tracked")));
}

TEST(FrameSpellings, ASecondFrameOrNoneIsRefused) {
  rdf::Graph graph = graph_of(random_frame(1));
  graph.push_back({rdf::iri("other"), rdf::iri(rdf::rdf("type")), rdf::iri(kNs + "Frame")});
  EXPECT_FALSE(read_graph_as(graph));
  EXPECT_FALSE(read_frame("", Format::Turtle));
  EXPECT_FALSE(read_frame("<a> <b> <c> .", Format::Turtle));
}

TEST(FrameSpellings, TheTemplateReaderLeavesStrangeSpellingsToTheParser) {
  const std::string ours = write(random_frame(1), Format::Turtle);
  ASSERT_TRUE(read_template(ours));
  for (const auto& [part, instead] :
       std::vector<std::pair<std::string, std::string>>{{" ;\n", ";\n"},
                                                        {"ch:sequence", "ch:sequence "},
                                                        {"@prefix ch:", "@prefix  ch:"},
                                                        {" a ", " rdf:type "}}) {
    std::string other = ours;
    const auto at = other.find(part);
    ASSERT_NE(at, std::string::npos) << part;
    other.replace(at, part.size(), instead);
    EXPECT_FALSE(read_template(other)) << instead;
  }
  EXPECT_FALSE(read_template(ours + " "));
  EXPECT_FALSE(read_template(ours.substr(0, ours.size() - 1)));
  EXPECT_FALSE(read_template(""));
}

}  // namespace
}  // namespace chorus::resource
