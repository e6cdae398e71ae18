// proto/vocab/chorus.ttl compared with proto/context.jsonld and proto/shapes.ttl.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "common/rdf/turtle_reader.h"
#include "common/resource/terms.h"
#include "proto/embedded.h"

namespace chorus::resource {
namespace {

constexpr std::string_view kRdfs = "http://www.w3.org/2000/01/rdf-schema#";

struct Word {
  bool is_property = false;
  std::set<std::string> said;  ///< Predicates used.
};

std::map<std::string, Word> words() {
  const auto graph = rdf::read_graph(proto::vocabulary());
  EXPECT_TRUE(graph) << to_string(graph.error());
  std::map<std::string, Word> found;
  for (const rdf::Triple& triple : graph.value_or(rdf::Graph{})) {
    if (triple.subject.value == kChorus) continue;
    Word& word = found[triple.subject.value];
    word.said.insert(triple.predicate.value);
    if (triple.object.value == rdf::rdf("Property")) word.is_property = true;
  }
  return found;
}

std::string rdfs(std::string_view name) { return std::string(kRdfs).append(name); }

TEST(Vocabulary, ExplainsEveryWord) {
  for (const auto& [iri, word] : words()) {
    EXPECT_TRUE(word.said.contains(rdfs("label"))) << iri;
    EXPECT_TRUE(word.said.contains(rdfs("comment"))) << iri;
    if (!word.is_property) continue;
    EXPECT_TRUE(word.said.contains(rdfs("range"))) << iri;
    EXPECT_TRUE(word.said.contains(rdfs("domain")) ||
                word.said.contains("http://purl.org/dc/dcam/domainIncludes"))
        << iri;
  }
}

TEST(Vocabulary, HasEveryWordOfTheContextAndNoOther) {
  std::set<std::string> declared;
  for (const auto& [key, use] : all_terms()) {
    if (use.iri.starts_with(kChorus)) declared.insert(use.iri);
    if (use.index.starts_with(kChorus)) declared.insert(use.index);
  }
  const auto known = words();
  for (const std::string& iri : declared) {
    EXPECT_TRUE(known.contains(iri) && known.at(iri).is_property)
        << iri << " is not in the vocabulary";
  }
  for (const auto& [iri, word] : known) {
    if (!word.is_property) continue;
    EXPECT_TRUE(declared.contains(iri)) << iri << " is not in the context";
  }
}

TEST(Shapes, SpeakOnlyOfWordsThatExist) {
  const auto graph = rdf::read_graph(proto::shapes());
  ASSERT_TRUE(graph) << to_string(graph.error());
  const auto known = words();
  for (const rdf::Triple& triple : *graph) {
    const std::string& iri = triple.object.value;
    EXPECT_TRUE(!iri.starts_with(kChorus) || known.contains(iri)) << iri;
  }
}

}  // namespace
}  // namespace chorus::resource
