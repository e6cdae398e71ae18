#include "common/resource/node.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/rdf/turtle_reader.h"
#include "common/resource/terms.h"
#include "tests/support/graph/isomorphism.h"

namespace chorus::resource {
namespace {

using Json = nlohmann::json;

Node registration() {
  Node s1{"sensors/s1",
          {"RegisteredSensor"},
          {{"sensorId", std::string("s1")},
           {"x", Decimal{1.23456}},
           {"qw", Decimal{1, 5}},
           {"chain", std::vector<std::string>{"s1", "s2"}}}};
  Node s2{
      "sensors/s2", {"RegisteredSensor"}, {{"sensorId", std::string("s2")}, {"x", Decimal{-2}}}};
  Node session{"_", {"RegistrationSession"}, {{"state", std::string("idle")}}};
  return {"",
          {"Registration"},
          {{"version", std::int64_t{3}},
           {"verdict", std::string("Good")},
           {"reasons", std::vector<std::string>{"it \"works\"\n"}},
           {"solved", from_unix_ns(1'795'246'200'250'000'000)},
           {"nowNanoseconds", std::int64_t{1'795'246'200'250'000'000}},
           {"synchronised", true},
           {"session", session},
           {"sensors", std::vector<Node>{s1, s2}},
           {"contains", std::vector<Ref>{{"a"}, {"b"}}},
           {"weight", std::int64_t{1}},
           {"error", Decimal{std::numeric_limits<double>::quiet_NaN()}}}};
}

rdf::Graph read_at(std::string_view text, rdf::Syntax syntax) {
  const auto graph = rdf::read_graph(text, {syntax, "http://h/registration", {}});
  EXPECT_TRUE(graph) << to_string(graph.error()) << "\n" << text;
  return graph.value_or(rdf::Graph{});
}

TEST(Node, TurtleAndNTriplesAreItsGraph) {
  const Node node = registration();
  const Place place{"registration", "", "http://h/"};
  const auto turtle = write(node, Format::Turtle, place);
  EXPECT_EQ(testing::difference(*rdf::read_graph(turtle), graph_of(node)), "") << turtle;
  const auto triples = write(node, Format::NTriples, place);
  EXPECT_EQ(testing::difference(read_at(triples, rdf::Syntax::NTriples),
                                read_at(turtle, rdf::Syntax::Turtle)),
            "");
  EXPECT_NE(triples.find("<http://h/sensors/s1>"), std::string::npos) << triples;
}

TEST(Node, JsonIsPlain) {
  const Json json = Json::parse(write(registration(), Format::Json));
  EXPECT_EQ(json.at("@type"), "Registration");
  EXPECT_EQ(json.at("version"), 3);
  EXPECT_EQ(json.at("verdict"), "Good");
  EXPECT_EQ(json.at("reasons"), Json({"it \"works\"\n"}));
  EXPECT_EQ(json.at("solved"), "2026-11-21T07:30:00.250000000Z");
  EXPECT_EQ(json.at("nowNanoseconds"), "1795246200250000000");
  EXPECT_EQ(json.at("sensors").at("s1").at("@id"), "sensors/s1");
  EXPECT_EQ(json.at("sensors").at("s1").at("x"), 1.2346);
  EXPECT_FALSE(json.at("sensors").at("s1").contains("sensorId")) << "it is the key";
  EXPECT_EQ(json.at("sensors").at("s1").at("chain"), Json({"s1", "s2"}));
  EXPECT_EQ(json.at("session"), Json({{"@type", "RegistrationSession"}, {"state", "idle"}}));
  EXPECT_EQ(json.at("contains"), Json({"a", "b"}));
  EXPECT_FALSE(json.contains("error")) << "not finite: left out";
  EXPECT_FALSE(json.contains("@context"));
}

TEST(Node, JsonLdHasTheContextAndTypedDecimals) {
  Node node = registration();
  node.properties.emplace_back("undeclared", Decimal{0.5, 1});
  const Json json = Json::parse(write(node, Format::JsonLd, {"sensors/", "", "http://h/"}));
  EXPECT_EQ(json.at("@context"), "../context.jsonld");
  EXPECT_EQ(json.at("sensors").at("s1").at("x"), "1.2346");
  EXPECT_EQ(json.at("undeclared"), Json({{"@type", "xsd:decimal"}, {"@value", "0.5"}}));
}

std::string golden(const std::string& name) {
  std::ifstream file("proto/golden/documents/" + name, std::ios::binary);
  EXPECT_TRUE(file) << name;
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Node, GoldenDocumentsAreWrittenByteForByte) {
  const Place place{"registration", "", "http://localhost/"};
  EXPECT_EQ(write(registration(), Format::Turtle, place), golden("registration.ttl"));
  EXPECT_EQ(write(registration(), Format::JsonLd, place), golden("registration.jsonld"));
  EXPECT_EQ(write(registration(), Format::Json, place), golden("registration.json"));
}

TEST(Node, TextFromElsewhereCannotBreakADocument) {
  const Node node{"",
                  {},
                  {{"lastError", std::string("\xFF\0\"\\ <", 6)},
                   {"url", std::string("http://a b/<\"")},
                   {"master", std::string("</script>")}}};
  for (const Format format : {Format::Turtle, Format::NTriples}) {
    const auto text = write(node, format);
    EXPECT_EQ(read_at(text, format == Format::Turtle ? rdf::Syntax::Turtle : rdf::Syntax::NTriples)
                  .size(),
              3U)
        << text;
  }
  EXPECT_EQ(Json::parse(write(node, Format::Json)).size(), 4U);
}

TEST(Node, FindsUndeclaredTermsInAnyDepth) {
  EXPECT_TRUE(undeclared_terms(registration()).empty());
  Node node = registration();
  node.properties.emplace_back("session", Node{"_", {}, {{"oops", true}}});
  EXPECT_EQ(undeclared_terms(node), std::vector<std::string>{"oops"});
}

TEST(Node, ADocumentOffersTheFourFormats) {
  const auto document = document_of(registration(), {.version = "7"}, {"registration"});
  const auto turtle = document->choose("text/turtle", "");
  ASSERT_TRUE(turtle) << to_string(turtle.error());
  EXPECT_EQ((*turtle)->body(), write(registration(), Format::Turtle, {"registration"}));
  EXPECT_EQ((*document->choose("", ""))->media_type, "text/turtle");
  EXPECT_EQ((*document->choose("application/ld+json", ""))->media_type, "application/ld+json");
  EXPECT_EQ((*document->choose("application/json", ""))->media_type, "application/json");
  EXPECT_EQ((*document->choose("application/n-triples", ""))->media_type, "application/n-triples");
}

}  // namespace
}  // namespace chorus::resource
