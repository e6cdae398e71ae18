// Any graph that can be written is read back unchanged: random graphs, and awkward hand-made ones.
#include <random>

#include <gtest/gtest.h>

#include "common/rdf/turtle_reader.h"
#include "common/rdf/turtle_writer.h"
#include "tests/support/graph/isomorphism.h"

namespace chorus::rdf {
namespace {

const std::vector<Prefix> kPrefixes{{"e", "http://e/"}, {"x", "http://e/x#"}};

/// Terms that have caused errors in readers and writers.
const std::vector<std::string> kTexts{"",
                                      " ",
                                      "a\"b",
                                      "a\\",
                                      "\\\"",
                                      "\"\"\"",
                                      "'''",
                                      "line\nline\r\n\ttab",
                                      "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80",
                                      "# no comment",
                                      "<no iri>",
                                      "[ ( ) ] ; , .",
                                      "@en",
                                      "^^x",
                                      "\x7F"};
const std::vector<std::string> kIris{
    "http://e/a", "http://e/x#b", "http://e/a%20b", "http://e/a.b.c",
    "urn:uuid:1", "rel/ative",    "#here",          "",
    "http://e/",  "http://e/1",   "http://e/-x",    "http://\xC3\xA4.example/"};

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  int roll(std::size_t sides) {
    return std::uniform_int_distribution<int>(0, static_cast<int>(sides) - 1)(random_);
  }
  const std::string& one_of(const std::vector<std::string>& all) {
    return all[static_cast<std::size_t>(roll(all.size()))];
  }

 private:
  std::mt19937 random_;
};

Term any_blank(Dice& dice) { return blank("b" + std::to_string(dice.roll(6))); }

Term any_object(Dice& dice) {
  switch (dice.roll(6)) {
    case 0:
      return any_blank(dice);
    case 1:
      return literal(dice.one_of(kTexts), "http://e/type");
    case 2:
      return Term{TermKind::Literal, dice.one_of(kTexts), "", dice.roll(2) ? "de" : "en-GB"};
    case 3:
      return literal(std::to_string(dice.roll(1000)), xsd("integer"));
    case 4:
      return literal(dice.one_of(kTexts));
    default:
      return iri(dice.one_of(kIris));
  }
}

Graph any_graph(unsigned seed) {
  Dice dice(seed);
  Graph graph;
  const int triples = dice.roll(12);
  for (int i = 0; i < triples; ++i) {
    const Term subject = dice.roll(3) == 0 ? any_blank(dice) : iri(dice.one_of(kIris));
    graph.push_back({subject, iri("http://e/p" + std::to_string(dice.roll(3))), any_object(dice)});
  }
  return graph;
}

TEST(RoundTrip, OfAHundredRandomGraphsAsTurtle) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Graph graph = any_graph(seed);
    const auto text = write_graph(graph, {Syntax::Turtle, kPrefixes, {}});
    ASSERT_TRUE(text) << seed << ": " << to_string(text.error());
    const auto back = read_graph(*text);
    ASSERT_TRUE(back) << seed << ": " << to_string(back.error()) << "\n" << *text;
    EXPECT_EQ(testing::difference(graph, *back), "") << seed << "\n" << *text;
  }
}

TEST(RoundTrip, OfAHundredRandomGraphsAsNTriples) {
  const std::string base = "http://h/frames/42";
  for (unsigned seed = 0; seed < 100; ++seed) {
    const auto turtle = write_graph(any_graph(seed), {Syntax::Turtle, kPrefixes, {}});
    const auto direct = write_graph(any_graph(seed), {Syntax::NTriples, {}, base});
    const auto through = turtle_to_ntriples(turtle.value(), base, 1'000'000);
    ASSERT_TRUE(direct && through) << seed;
    ReadOptions options;
    options.syntax = Syntax::NTriples;
    const auto first = read_graph(*direct, options);
    const auto second = read_graph(*through, options);
    ASSERT_TRUE(first && second) << seed << "\n" << *direct << "\n" << *through;
    EXPECT_EQ(testing::difference(*first, *second), "") << seed;
  }
}

TEST(RoundTrip, WritingTheSameGraphTwiceGivesTheSameBytes) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(write_graph(any_graph(seed), {}), write_graph(any_graph(seed), {}));
  }
}

TEST(NTriples, EscapesWhatALineCannotHoldAndNothingElse) {
  const auto text = turtle_to_ntriples(
      "<http://a> <http://b> \"q\\\" b\\\\ n\\n r\\r t\\t \xC3\xA4\" .", "http://h/", 1000);
  ASSERT_TRUE(text);
  EXPECT_EQ(*text, "<http://a> <http://b> \"q\\\" b\\\\ n\\n r\\r t\t \xC3\xA4\" .\n");
}

TEST(NTriples, NamesLanguagesTypesAndBlankNodesInFull) {
  const auto text = turtle_to_ntriples(
      "@prefix e: <http://e/> . _:n e:p \"t\"@en , 1.5 , true , \"x\"^^e:t .", "http://h/", 1000);
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("\"t\"@en .\n"), std::string::npos) << *text;
  EXPECT_NE(text->find("\"1.5\"^^<" + xsd("decimal") + "> .\n"), std::string::npos);
  EXPECT_NE(text->find("\"true\"^^<" + xsd("boolean") + "> .\n"), std::string::npos);
  EXPECT_NE(text->find("\"x\"^^<http://e/t> .\n"), std::string::npos);
  EXPECT_EQ(text->find("_:"), 0U);
  EXPECT_EQ(std::count(text->begin(), text->end(), '\n'), 4);
}

TEST(NTriples, TooLongOrBrokenDocumentsAreErrors) {
  const auto longer = turtle_to_ntriples("<a> <b> <c> .", "http://h/", 5);
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().code, ErrorCode::TooLarge);
  EXPECT_NE(longer.error().message.find("at most 5"), std::string::npos);
  EXPECT_FALSE(turtle_to_ntriples("<a> <b> [", "http://h/", 1000));
  EXPECT_EQ(turtle_to_ntriples("", "http://h/", 1000).value(), "");
}

TEST(TurtleWriter, RefusesEveryCharacterThatNoIriHas) {
  for (const char c : std::string("<>\"{}|^`\\ \n\x01")) {
    const std::string name = std::string("http://e/a") + c;
    EXPECT_FALSE(write_graph({{iri(name), iri("http://p"), iri("http://o")}}, {})) << c;
    EXPECT_FALSE(write_graph({{iri("http://s"), iri("http://p"), literal("1", name)}}, {})) << c;
  }
  EXPECT_FALSE(write_graph({{blank("a b"), iri("http://p"), iri("http://o")}}, {}));
  EXPECT_FALSE(write_graph({{blank(""), iri("http://p"), iri("http://o")}}, {}));
  const Term odd{TermKind::Literal, "a", "", "e n"};
  EXPECT_FALSE(write_graph({{iri("http://s"), iri("http://p"), odd}}, {}));
  EXPECT_FALSE(
      write_graph({{iri("http://s"), iri("http://p"), literal(std::string("a\0b", 3))}}, {}));
}

TEST(TurtleWriter, AnErrorNamesTheTermAndKeepsItShort) {
  const auto text = write_graph({{iri(std::string(500, ' ')), iri("p"), iri("o")}}, {});
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(text.error().context.size(), 80U);
}

TEST(ResolveIri, FollowsTheExamplesOfRfc3986) {
  const std::string base = "http://a/b/c/d;p?q";
  const std::vector<std::pair<std::string, std::string>> examples{{"g:h", "g:h"},
                                                                  {"g", "http://a/b/c/g"},
                                                                  {"./g", "http://a/b/c/g"},
                                                                  {"g/", "http://a/b/c/g/"},
                                                                  {"/g", "http://a/g"},
                                                                  {"//g", "http://g"},
                                                                  {"?y", "http://a/b/c/d;p?y"},
                                                                  {"g?y", "http://a/b/c/g?y"},
                                                                  {"#s", "http://a/b/c/d;p?q#s"},
                                                                  {"./../g", "http://a/b/g"},
                                                                  {"", "http://a/b/c/d;p?q"},
                                                                  {"../../g", "http://a/g"},
                                                                  {"../g", "http://a/b/g"}};
  for (const auto& [reference, expected] : examples) {
    EXPECT_EQ(resolve_iri(reference, base), expected) << reference;
  }
}

}  // namespace
}  // namespace chorus::rdf
