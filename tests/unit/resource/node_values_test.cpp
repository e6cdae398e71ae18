// Each kind of value that a node can hold, in each format, and what is read back.
#include <limits>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/rdf/turtle_reader.h"
#include "common/resource/node.h"
#include "common/resource/terms.h"
#include "tests/support/graph/isomorphism.h"

namespace chorus::resource {
namespace {

using Json = nlohmann::json;
using rdf::Term;

/// The objects of one property of the document's own node.
std::vector<Term> said(const Node& node, std::string_view key) {
  std::vector<Term> objects;
  for (const rdf::Triple& triple : graph_of(node)) {
    if (triple.subject == rdf::iri(node.id) &&
        triple.predicate.value == term(key, node.types).iri) {
      objects.push_back(triple.object);
    }
  }
  return objects;
}

Node with(const std::string& key, Value value) {
  return {"", {"Registration"}, {{key, std::move(value)}}};
}

Json plain(const Node& node) { return Json::parse(write(node, Format::Json)); }
Json linked(const Node& node) { return Json::parse(write(node, Format::JsonLd)); }

TEST(NodeValues, TruthsAndIntegersKeepTheirDatatype) {
  const Node node = with("synchronised", true);
  EXPECT_EQ(said(node, "synchronised"), std::vector{rdf::literal("true", rdf::xsd("boolean"))});
  EXPECT_EQ(plain(node).at("synchronised"), true);
  const Node version = with("version", std::int64_t{-3});
  EXPECT_EQ(said(version, "version"), std::vector{rdf::literal("-3", rdf::xsd("integer"))});
  EXPECT_EQ(plain(version).at("version"), -3);
}

TEST(NodeValues, IntegersBeyondADoubleAreTextInJson) {
  const std::int64_t most = std::int64_t{1} << 53;
  EXPECT_EQ(plain(with("version", most - 1)).at("version"), most - 1);
  EXPECT_EQ(plain(with("version", most)).at("version"), "9007199254740992");
  EXPECT_EQ(plain(with("version", -most)).at("version"), "-9007199254740992");
  EXPECT_EQ(said(with("version", most), "version").front().value, "9007199254740992");
  EXPECT_EQ(plain(with("nowNanoseconds", std::int64_t{5})).at("nowNanoseconds"), "5");
}

TEST(NodeValues, DecimalsHaveTheDigitsTheyAreGiven) {
  for (int digits = 1; digits <= 8; ++digits) {
    const Node node = with("error", Decimal{1.0 / 3.0, digits});
    const std::string text = "0." + std::string(static_cast<std::size_t>(digits), '3');
    EXPECT_EQ(said(node, "error"), std::vector{rdf::literal(text, rdf::xsd("decimal"))});
    EXPECT_NEAR(plain(node).at("error").get<double>(), 1.0 / 3.0, 0.5 * std::pow(10.0, -digits));
  }
}

TEST(NodeValues, WhatIsNoDecimalIsLeftOutEverywhere) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    const Node node = with("error", Decimal{bad});
    EXPECT_TRUE(said(node, "error").empty());
    EXPECT_FALSE(plain(node).contains("error"));
    EXPECT_FALSE(linked(node).contains("error"));
  }
  const Node some = {
      "", {"Image"}, {{"distortion", std::vector<Decimal>{{1.0, 1}, {std::nan(""), 1}, {2.0, 1}}}}};
  EXPECT_EQ(plain(some).at("distortion"), Json({1.0, 2.0}));
}

TEST(NodeValues, TimesAreDateTimesToTheNanosecond) {
  const Node node = with("solved", from_unix_ns(1'795'246'200'250'000'001));
  EXPECT_EQ(said(node, "solved"),
            std::vector{rdf::literal("2026-11-21T07:30:00.250000001Z", rdf::xsd("dateTime"))});
  EXPECT_EQ(plain(node).at("solved"), "2026-11-21T07:30:00.250000001Z");
}

TEST(NodeValues, AWordUnderAVocabularyTermIsAnIndividual) {
  EXPECT_EQ(said(with("verdict", std::string("Good")), "verdict"),
            std::vector{rdf::iri(class_iri("Good"))});
  EXPECT_EQ(said(with("reasons", std::vector<std::string>{"Good"}), "reasons"),
            std::vector{rdf::literal("Good")});
}

TEST(NodeValues, ListsKeepTheirOrder) {
  const Node node{"", {"RegisteredSensor"}, {{"chain", std::vector<std::string>{"b", "a", "b"}}}};
  EXPECT_EQ(plain(node).at("chain"), Json({"b", "a", "b"}));
  const auto turtle = write(node, Format::Turtle);
  const auto graph = rdf::read_graph(turtle);
  ASSERT_TRUE(graph);
  EXPECT_EQ(testing::difference(*graph, graph_of(node)), "");
}

TEST(NodeValues, ReferencesAreIrisRelativeToTheDocument) {
  const Node node = with("contains", std::vector<Ref>{{"sensors/s1"}, {"http://x/y"}});
  EXPECT_EQ(said(node, "contains"), (std::vector{rdf::iri("sensors/s1"), rdf::iri("http://x/y")}));
  const std::string triples = write(node, Format::NTriples, {"registration", "", "http://h/"});
  EXPECT_NE(triples.find("<http://h/sensors/s1>"), std::string::npos) << triples;
  EXPECT_NE(triples.find("<http://x/y>"), std::string::npos);
}

TEST(NodeValues, NodesInNodesHaveSubjectsOfTheirOwn) {
  const Node inner{"sensors/s1", {"RegisteredSensor"}, {{"error", Decimal{0.5, 1}}}};
  const Node nameless{"_", {"RegistrationSession"}, {{"state", std::string("idle")}}};
  Node node = with("session", nameless);
  node.properties.emplace_back("sensors", std::vector<Node>{inner});
  const rdf::Graph graph = graph_of(node);
  const auto about = [&](rdf::TermKind kind) {
    return std::count_if(graph.begin(), graph.end(),
                         [&](const auto& triple) { return triple.subject.kind == kind; });
  };
  EXPECT_EQ(about(rdf::TermKind::Blank), 2);  // the type and the state of the session
  EXPECT_EQ(said(node, "sensors"), std::vector{rdf::iri("sensors/s1")});
  EXPECT_FALSE(plain(node).at("session").contains("@id"));
}

TEST(NodeValues, SeveralTypesAreAllStated) {
  const Node node{"", {"ldp:BasicContainer", "Registration"}, {}};
  EXPECT_EQ(plain(node).at("@type"), Json({"ldp:BasicContainer", "Registration"}));
  EXPECT_EQ(graph_of(node).size(), 2U);
  EXPECT_FALSE(plain(Node{"", {}, {}}).contains("@type"));
}

TEST(NodeValues, TurtleAndNTriplesHoldTheSameGraphForEveryKind) {
  Node node = with("version", std::int64_t{3});
  node.properties.emplace_back("solved", from_unix_ns(1));
  node.properties.emplace_back("error", Decimal{-0.25, 2});
  node.properties.emplace_back("reasons", std::vector<std::string>{"a", "\"b\"\n", "\xC3\xA4"});
  node.properties.emplace_back("contains", std::vector<Ref>{{"x"}});
  node.properties.emplace_back("session", Node{"_", {}, {{"state", std::string("idle")}}});
  const Place place{"registration", "", "http://h/"};
  rdf::ReadOptions options;
  options.base = "http://h/registration";
  const auto turtle = rdf::read_graph(write(node, Format::Turtle, place), options);
  const auto triples =
      rdf::read_graph(write(node, Format::NTriples, place), {rdf::Syntax::NTriples, {}, {}});
  ASSERT_TRUE(turtle && triples);
  EXPECT_EQ(testing::difference(*turtle, *triples), "");
}

TEST(Place, LeadsBackToTheRootFromAnyDepth) {
  EXPECT_EQ((Place{"frame"}).up(), "");
  EXPECT_EQ((Place{""}).up(), "");
  EXPECT_EQ((Place{"sensors/"}).up(), "../");
  EXPECT_EQ((Place{"frames/42"}).up(), "../");
  EXPECT_EQ((Place{"registration/sessions/1"}).up(), "../../");
}

TEST(MediaType, IsOneForEachFormat) {
  std::vector<std::string_view> names;
  for (const Format format : kFormats) names.push_back(media_type(format));
  EXPECT_EQ(names, (std::vector<std::string_view>{"text/turtle", "application/ld+json",
                                                  "application/json", "application/n-triples"}));
}

}  // namespace
}  // namespace chorus::resource
