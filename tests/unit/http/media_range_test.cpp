#include "common/http/media_range.h"

#include <gtest/gtest.h>

#include <array>

namespace chorus::http {
namespace {

constexpr std::array<std::string_view, 4> kOffers{"text/turtle", "application/ld+json",
                                                  "application/json", "application/n-triples"};

std::string_view chosen(std::string_view accept) {
  const auto index = negotiate(kOffers, accept);
  return index ? kOffers[*index] : "none";
}

TEST(Negotiation, WithoutPreferenceTakesTheFirst) {
  for (const auto accept : {"", "*/*", "text/*", "  ", ",,", "text/*;q=0.1, */*;q=0.1"})
    EXPECT_EQ(chosen(accept), "text/turtle") << accept;
}

TEST(Negotiation, HigherQualityWins) {
  EXPECT_EQ(chosen("text/turtle;q=0.5, application/json"), "application/json");
  EXPECT_EQ(chosen("text/turtle;q=0.9,application/json;q=0.8"), "text/turtle");
  EXPECT_EQ(chosen("application/ld+json, application/json;q=0.5"), "application/ld+json");
  EXPECT_EQ(chosen("text/turtle;q=0.501, application/json;q=0.502"), "application/json");
}

TEST(Negotiation, TiesKeepTheServersOrder) {
  EXPECT_EQ(chosen("application/n-triples, application/json, text/turtle"), "text/turtle");
}

TEST(Negotiation, SpecificRangesOverrideWildcards) {
  EXPECT_EQ(chosen("*/*, text/turtle;q=0"), "application/ld+json");
  EXPECT_EQ(chosen("text/*;q=0.2, text/turtle;q=0, application/*;q=0.1"), "application/ld+json");
  EXPECT_EQ(chosen("*/*;q=0.1, application/json;q=0.2"), "application/json");
}

TEST(Negotiation, QualityZeroAndUnknownTypesAreNotAcceptable) {
  EXPECT_EQ(chosen("image/png"), "none");
  EXPECT_EQ(chosen("*/*;q=0"), "none");
  EXPECT_EQ(chosen("text/turtle;q=0.000"), "none");
}

TEST(Negotiation, RealClients) {
  EXPECT_EQ(
      chosen("application/rdf+xml;q=0.9, text/rdf+n3, application/xhtml+xml;q=0.5, */*;q=0.1"),
      "text/turtle");  // rdflib's Accept field
  EXPECT_EQ(chosen("application/n-quads,application/trig;q=0.95,application/ld+json;q=0.9,"
                   "application/n-triples;q=0.8,text/turtle;q=0.6"),
            "application/ld+json");  // Comunica's Accept field
  EXPECT_EQ(chosen("text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"),
            "text/turtle");  // a browser's Accept field, when no HTML is offered
}

TEST(Negotiation, CaseSpaceAndParameters) {
  EXPECT_EQ(chosen("APPLICATION/JSON ; charset=utf-8 ; Q=1.0"), "application/json");
  EXPECT_EQ(chosen("application/ld+json;profile=\"a,b;q=0\", text/turtle;q=0.3"),
            "application/ld+json");
}

TEST(Negotiation, BrokenElementsAreSkipped) {
  EXPECT_EQ(chosen("turtle, */turtle, /x, x/, application/json"), "application/json");
  EXPECT_EQ(chosen("text/turtle;q=2, application/json;q=0.1"), "application/json");
  EXPECT_EQ(chosen("text/turtle;q=0.1234, application/json;q=0.1"), "application/json");
  EXPECT_EQ(chosen("text/turtle;q=, application/json;q=0.1"), "application/json");
}

TEST(Negotiation, NothingOnOffer) { EXPECT_FALSE(negotiate({}, "*/*")); }

TEST(Quality, ExplicitMeansNamedInFull) {
  EXPECT_EQ(explicit_quality_of("text/event-stream", "text/event-stream;q=0.5"), 500);
  EXPECT_FALSE(explicit_quality_of("text/event-stream", "text/*, */*"));
  EXPECT_EQ(quality_of("text/event-stream", "text/*;q=0.25"), 250);
}

}  // namespace
}  // namespace chorus::http
