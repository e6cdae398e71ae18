#include "common/rdf/turtle_reader.h"

#include <gtest/gtest.h>

#include <string>

namespace chorus::rdf {
namespace {

TEST(TurtleReader, ReadsEveryKindOfTerm) {
  const auto graph = read_graph(
      "@prefix e: <http://e/> . <s> e:p <http://o> , [ e:q 1 ] , 1.50 , true , \"t\"@en , "
      "\"d\"^^e:type , \"plain\" , \"typed\"^^<http://www.w3.org/2001/XMLSchema#string> .");
  ASSERT_TRUE(graph) << to_string(graph.error());
  ASSERT_EQ(graph->size(), 9U);
  const Term s = iri("s");
  const Term p = iri("http://e/p");
  EXPECT_EQ((*graph)[0], (Triple{s, p, iri("http://o")}));
  EXPECT_EQ((*graph)[1].object.kind, TermKind::Blank);
  EXPECT_EQ((*graph)[2].subject, (*graph)[1].object);
  EXPECT_EQ((*graph)[3].object, literal("1.50", xsd("decimal")));
  EXPECT_EQ((*graph)[4].object, literal("true", xsd("boolean")));
  EXPECT_EQ((*graph)[5].object, (Term{TermKind::Literal, "t", "", "en"}));
  EXPECT_EQ((*graph)[6].object, literal("d", "http://e/type"));
  EXPECT_EQ((*graph)[7].object, literal("plain"));
  EXPECT_EQ((*graph)[8].object, literal("typed")) << "xsd:string is what a plain literal is";
}

TEST(TurtleReader, ResolvesAgainstABaseOnlyWhenThereIsOne) {
  ReadOptions options;
  options.base = "http://h/frames/42";
  EXPECT_EQ(read_graph("<../a> <b> <> .", options)->front(),
            (Triple{iri("http://h/a"), iri("http://h/frames/b"), iri("http://h/frames/42")}));
  EXPECT_EQ(read_graph("<a> <b> <> .")->front(), (Triple{iri("a"), iri("b"), iri("")}));
  EXPECT_EQ(read_graph("@base <http://x/> . <a> <b> <c> .")->front().subject, iri("http://x/a"));
}

TEST(TurtleReader, NamesTheLineOfASyntaxError) {
  const auto graph = read_graph("<a> <b> 1 .\n<a> <b> 2 .\n<a> <b> ; .\n");
  ASSERT_FALSE(graph);
  EXPECT_EQ(graph.error().code, ErrorCode::Malformed);
  EXPECT_EQ(graph.error().context, "line 3");
  EXPECT_FALSE(graph.error().message.empty());
}

TEST(TurtleReader, NamesAnUndeclaredPrefixAndItsLine) {
  const auto graph = read_graph("<a> <b> 1 .\n<a> x:y 2 .\n");
  ASSERT_FALSE(graph);
  EXPECT_EQ(graph.error().context, "line 2");
  EXPECT_NE(graph.error().message.find("'x:y'"), std::string::npos) << graph.error().message;
}

TEST(TurtleReader, IsStrict) {
  EXPECT_FALSE(read_graph("<a> <b> \"\xFF\" .")) << "broken UTF-8";
  EXPECT_FALSE(read_graph("<a> <b> <c d> ."));
  EXPECT_FALSE(read_graph("<a> <b> 1 .\nnonsense\n<a> <b> 2 .")) << "does not resume";
  EXPECT_FALSE(read_graph("<a> <b> 1"));
  EXPECT_FALSE(read_graph("1 <b> 1 ."));
}

TEST(TurtleReader, TheSinkMayStopIt) {
  int seen = 0;
  const auto ok = read_triples("<a> <b> 1, 2, 3 . and then rubbish", {},
                               [&seen](const TripleView&) { return ++seen < 2; });
  EXPECT_TRUE(ok);
  EXPECT_EQ(seen, 2);
}

TEST(TurtleReader, ReadsNTriples) {
  ReadOptions options;
  options.syntax = Syntax::NTriples;
  EXPECT_EQ(read_graph("<http://a> <http://b> \"x\\ny\" .\n", options)->front().object,
            literal("x\ny"));
  EXPECT_FALSE(read_graph("<http://a> <http://b> 1 .\n", options));
}

TEST(TurtleReader, LongListsAndLiteralsAreNoDepth) {
  std::string list = "<a> <b> (";
  for (int i = 0; i < 20'000; ++i) list += " 1";
  EXPECT_EQ(read_graph(list + " ) .")->size(), 40'001U);
  EXPECT_EQ(
      read_graph("<a> <b> \"" + std::string(1'000'000, 'x') + "\" .")->front().object.value.size(),
      1'000'000U);
}

TEST(TurtleReader, AnEmptyDocumentIsAnEmptyGraph) {
  EXPECT_TRUE(read_graph("# nothing\n")->empty());
}

}  // namespace
}  // namespace chorus::rdf
