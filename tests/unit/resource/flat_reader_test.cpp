#include "common/resource/flat_reader.h"

#include <gtest/gtest.h>

namespace chorus::resource {
namespace {

const std::string kPrefix = "@prefix ch: <https://w3id.org/chorus-tracking/ns#> . ";

Result<Properties> turtle(const std::string& text) {
  return read_properties(kPrefix + text, Format::Turtle, "Clock");
}

Result<Properties> json(const std::string& text) {
  return read_properties(text, Format::Json, "Clock");
}

TEST(FlatReader, TakesOurOwnLiteralsAndIndividualsOfTheOneSubject) {
  const auto read = turtle(
      "<clock> a ch:Clock ; ch:offset 1.5 ; ch:state ch:Good ; ch:name \"a b\" ; "
      "<http://other/p> 3 ; ch:link <elsewhere> . <other> ch:offset 7 .");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(*read, (Properties{{"offset", "1.5"}, {"state", "Good"}, {"name", "a b"}}));
}

TEST(FlatReader, JsonGivesTheSame) {
  const auto read = json(
      R"({"@type": "Clock", "@id": "clock", "offset": 1.5, "state": "Good", "name": "a b",
          "list": [1], "nothing": null, "object": {"a": 1}, "truth": true})");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(*read,
            (Properties{{"offset", "1.5"}, {"state", "Good"}, {"name", "a b"}, {"truth", "true"}}));
}

TEST(FlatReader, JsonLdAndNTriplesAreReadToo) {
  EXPECT_TRUE(read_properties(R"({"@context": "x", "@type": "Clock", "offset": "2"})",
                              Format::JsonLd, "Clock"));
  const auto triples = read_properties(
      "<http://h/c> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> "
      "<https://w3id.org/chorus-tracking/ns#Clock> .\n"
      "<http://h/c> <https://w3id.org/chorus-tracking/ns#offset> "
      "\"2\"^^<http://www.w3.org/2001/XMLSchema#integer> .\n",
      Format::NTriples, "Clock");
  ASSERT_TRUE(triples) << to_string(triples.error());
  EXPECT_EQ(triples->at("offset"), "2");
}

TEST(FlatReader, NeedsExactlyOneSubjectOfTheType) {
  for (const auto& none : {turtle(""), turtle("<a> a ch:Frame ; ch:offset 1 ."), json("{}"),
                           json(R"({"@type": "Frame"})"), json(R"({"@type": ["Clock"]})"),
                           turtle("<a> a ch:Clock . <b> a ch:Clock .")}) {
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::Malformed);
    EXPECT_EQ(none.error().message, "the document holds no ch:Clock");
  }
  EXPECT_TRUE(turtle("<a> a ch:Clock . <a> a ch:Clock , ch:Thing ."));
}

TEST(FlatReader, TwoValuesAreRefusedAndTheSameTwiceIsOne) {
  const auto twice = turtle("<a> a ch:Clock ; ch:offset 1 , 2 .");
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().context, "ch:offset");
  EXPECT_TRUE(turtle("<a> a ch:Clock ; ch:offset 1 , 1 ."));
  EXPECT_FALSE(json(R"({"@type": "Clock", "offset": 1, "offset": 2})"));
}

TEST(FlatReader, BrokenDocumentsAreErrorsInEveryFormat) {
  for (const Format format : kFormats) {
    EXPECT_FALSE(read_properties("{<", format, "Clock")) << media_type(format);
    EXPECT_FALSE(read_properties("", format, "Clock")) << media_type(format);
    EXPECT_FALSE(read_properties(std::string(3'000'000, ' '), format, "Clock"));
  }
}

TEST(NumberOf, IsFiniteOrAnErrorThatNamesTheProperty) {
  const Properties properties{{"a", "1.5"}, {"b", "NaN"}, {"c", ""}, {"d", "1e999"}, {"e", "-2e3"}};
  EXPECT_EQ(number_of(properties, "a").value(), 1.5);
  EXPECT_EQ(number_of(properties, "e").value(), -2000.0);
  for (const char* key : {"b", "c", "d"}) {
    const auto bad = number_of(properties, key);
    ASSERT_FALSE(bad) << key;
    EXPECT_EQ(bad.error().message, "is no finite number");
    EXPECT_EQ(bad.error().context, std::string("ch:") + key);
  }
  EXPECT_EQ(number_of(properties, "z").error().message, "is missing");
}

}  // namespace
}  // namespace chorus::resource
