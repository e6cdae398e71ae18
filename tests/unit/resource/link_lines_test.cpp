#include "common/resource/link_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace chorus::resource {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<http::Variant> turtle_json_ld_and_json() {
  std::vector<http::Variant> variants;
  for (const char* type : {"text/turtle", "application/ld+json", "application/json"})
    variants.push_back({type, [] { return std::string("x"); }});
  return linked(std::move(variants), Kind::Source);
}

TEST(LinkedData, EveryKindOfResourceSaysWhatItIs) {
  EXPECT_EQ(link_lines(Kind::Source),
            "Link: <http://www.w3.org/ns/ldp#RDFSource>; rel=\"type\"\r\n"
            "Link: </shapes>; rel=\"describedby\"\r\n");
  EXPECT_EQ(link_lines(Kind::Container),
            "Link: <http://www.w3.org/ns/ldp#BasicContainer>; rel=\"type\"\r\n" +
                std::string(link_lines(Kind::Source)));
  EXPECT_EQ(link_lines(Kind::Other),
            "Link: <http://www.w3.org/ns/ldp#NonRDFSource>; rel=\"type\"\r\n");
}

TEST(LinkedData, PlainJsonNamesItsContextAndJsonLdDoesNot) {
  const auto variants = turtle_json_ld_and_json();
  EXPECT_EQ(variants[0].lines, link_lines(Kind::Source));
  EXPECT_EQ(variants[1].lines, link_lines(Kind::Source));
  EXPECT_EQ(variants[2].lines,
            std::string(link_lines(Kind::Source)) +
                "Link: </context.jsonld>; rel=\"http://www.w3.org/ns/json-ld#context\"; "
                "type=\"application/ld+json\"\r\n");
}

TEST(LinkedData, JsonWithoutAJsonLdTwinHasNoContext) {
  const auto document = other_document("application/json", "{}", {});
  EXPECT_THAT(std::string((*document->choose(""))->head()), HasSubstr("ldp#NonRDFSource"));
  EXPECT_THAT(std::string((*document->choose(""))->head()), Not(HasSubstr("context")));
}

TEST(LinkedData, AnswersNameTheServicesDescriptionAndClock) {
  const auto policy = answer_policy();
  EXPECT_EQ(policy.clock_field, "Chorus-Clock");
  EXPECT_EQ(policy.lines, "Link: </openapi.json>; rel=\"service-desc\"\r\n");
  EXPECT_EQ(policy.resource_lines, "Link: <http://www.w3.org/ns/ldp#Resource>; rel=\"type\"\r\n");
}

}  // namespace
}  // namespace chorus::resource
