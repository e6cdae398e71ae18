#include "common/rdf/turtle_writer.h"

#include <gtest/gtest.h>

#include "common/rdf/turtle_reader.h"
#include "common/rdf/utf8.h"
#include "tests/support/graph/isomorphism.h"

namespace chorus::rdf {
namespace {

Graph sample() {
  const Term s = iri("s#1");
  return {{s, iri(rdf("type")), iri("http://e/Thing")},
          {s, iri("http://e/x"), literal("-1.2500", xsd("decimal"))},
          {s, iri("http://e/n"), literal("42", xsd("integer"))},
          {s, iri("http://e/text"), literal("line\nand \"quote\" and \xC3\xA4 \\")},
          {s, iri("http://e/said"), Term{TermKind::Literal, "hallo", "", "de"}},
          {s, iri("http://e/has"), blank("b1")},
          {blank("b1"), iri("http://e/has"), blank("b2")},
          {blank("b2"), iri("http://e/t"), literal("2026-01-01T00:00:00Z", xsd("dateTime"))},
          {s, iri("http://e/ring"), blank("r1")},
          {s, iri("http://e/ring"), blank("r2")},
          {blank("r1"), iri("http://e/next"), blank("r2")},
          {blank("r2"), iri("http://e/next"), blank("r1")}};
}

const WriteOptions kTurtle{Syntax::Turtle, {{"e", "http://e/"}, {"xsd", std::string(kXsd)}}, {}};

TEST(TurtleWriter, WhatItWritesReadsBackAsTheSameGraph) {
  const auto text = write_graph(sample(), kTurtle);
  ASSERT_TRUE(text) << to_string(text.error());
  const auto back = read_graph(*text);
  ASSERT_TRUE(back) << to_string(back.error()) << "\n" << *text;
  EXPECT_EQ(testing::difference(sample(), *back), "") << *text;
}

TEST(TurtleWriter, IsPleasantToRead) {
  const auto text = write_graph(sample(), kTurtle);
  EXPECT_NE(text->find("a e:Thing"), std::string::npos) << *text;
  EXPECT_NE(text->find("e:x -1.2500"), std::string::npos) << *text;
  EXPECT_NE(text->find("e:n 42"), std::string::npos) << *text;
  EXPECT_EQ(text->find("_:b1"), std::string::npos) << "a node used once is written in place\n"
                                                   << *text;
}

TEST(TurtleWriter, NTriplesHasAbsoluteIrisAndTheSameGraph) {
  const auto text = write_graph(sample(), {Syntax::NTriples, {}, "http://h/frames/42"});
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("<http://h/frames/s#1> "), std::string::npos) << *text;
  ReadOptions options;
  options.syntax = Syntax::NTriples;
  const auto triples = read_graph(*text, options);
  ASSERT_TRUE(triples) << to_string(triples.error());
  options = {};
  options.base = "http://h/frames/42";
  EXPECT_EQ(testing::difference(*triples, *read_graph(*write_graph(sample(), kTurtle), options)),
            "");
}

TEST(TurtleWriter, LosesNoRingOfBlankNodes) {
  const Graph ring{{blank("a"), iri("http://p"), blank("b")},
                   {blank("b"), iri("http://p"), blank("a")}};
  const auto text = write_graph(ring, {});
  EXPECT_EQ(testing::difference(*read_graph(*text), ring), "") << *text;
}

TEST(TurtleWriter, VeryDeepTreesStayReadable) {
  Graph deep;
  for (int i = 0; i < 1000; ++i) {
    deep.push_back(
        {blank("n" + std::to_string(i)), iri("http://p"), blank("n" + std::to_string(i + 1))});
  }
  const auto back = read_graph(*write_graph(deep, {}));
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->size(), deep.size());
}

TEST(TurtleWriter, RefusesWhatNoSyntaxCanHold) {
  EXPECT_FALSE(write_graph({{literal("a"), iri("b"), iri("c")}}, {}));
  EXPECT_FALSE(write_graph({{iri("a"), blank("b"), iri("c")}}, {}));
  EXPECT_FALSE(write_graph({{iri("a b"), iri("b"), iri("c")}}, {}));
  EXPECT_FALSE(write_graph({{iri("a"), iri("b"), literal("\xC3\x28")}}, {}));
}

TEST(TurtleToNTriples, IsTheSameGraphLineByLine) {
  const std::string turtle = *write_graph(sample(), kTurtle);
  const auto triples = turtle_to_ntriples(turtle, "http://h/x", turtle.size());
  ASSERT_TRUE(triples) << to_string(triples.error());
  ReadOptions options;
  options.syntax = Syntax::NTriples;
  const auto read = read_graph(*triples, options);
  ASSERT_TRUE(read) << to_string(read.error()) << "\n" << *triples;
  options = {};
  options.base = "http://h/x";
  EXPECT_EQ(testing::difference(*read, *read_graph(turtle, options)), "");
  EXPECT_FALSE(turtle_to_ntriples("<a> <b> .", "http://h/x", 100));
}

TEST(ResolveIri, FollowsRfc3986) {
  EXPECT_EQ(resolve_iri("../a", "http://h/b/c"), "http://h/a");
  EXPECT_EQ(resolve_iri("", "http://h/b/c"), "http://h/b/c");
  EXPECT_EQ(resolve_iri("#x", "http://h/b/c"), "http://h/b/c#x");
  EXPECT_EQ(resolve_iri("urn:x", "http://h/b/c"), "urn:x");
}

TEST(Utf8, ReplacesOnlyWhatIsBroken) {
  EXPECT_EQ(clean_utf8("a\xFFz\xC3\xA4"), "a\xEF\xBF\xBDz\xC3\xA4");
  EXPECT_FALSE(is_utf8("\xC0\xAF")) << "overlong";
  EXPECT_FALSE(is_utf8("\xED\xA0\x80")) << "surrogate";
  EXPECT_FALSE(is_utf8("\xF4\x90\x80\x80")) << "beyond Unicode";
  EXPECT_FALSE(is_utf8("\xE2\x82"));
  EXPECT_TRUE(is_utf8("\xF0\x9F\x98\x80 \xE2\x82\xAC"));
}

TEST(Difference, SeesWhatBlankNodesHide) {
  const Graph one{{iri("a"), iri("p"), blank("x")}, {blank("x"), iri("q"), literal("1")}};
  const Graph same{{iri("a"), iri("p"), blank("y")}, {blank("y"), iri("q"), literal("1")}};
  const Graph other{{iri("a"), iri("p"), blank("y")}, {blank("y"), iri("q"), literal("2")}};
  const Graph two{{iri("a"), iri("p"), blank("x")},
                  {iri("a"), iri("p"), blank("y")},
                  {blank("x"), iri("q"), literal("1")}};
  EXPECT_EQ(testing::difference(one, same), "");
  EXPECT_NE(testing::difference(one, other), "");
  EXPECT_NE(testing::difference(one, two), "");
}

}  // namespace
}  // namespace chorus::rdf
