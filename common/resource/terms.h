// The terms of our documents and their IRIs, as in proto/context.jsonld.
//
// There is only one table, the context file; it is built in and parsed once.  To add a term, add
// one line to the file and one paragraph to proto/vocab/chorus.ttl (a test compares the two).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/rdf/turtle_writer.h"

namespace chorus::resource {

inline constexpr std::string_view kChorus = "https://w3id.org/chorus-tracking/ns#";

enum class Container { None, Set, List, Index };

/// What a key means.
struct TermUse {
  std::string iri;
  std::string type = {};  ///< "@id", "@vocab", a datatype IRI, or empty: the value itself decides.
  Container container = Container::None;
  /// For Container::Index: IRI of the property whose value becomes the key.
  std::string index = {};
  /// False if the context lacks the key and the key has no prefix; it is then a name in our
  /// namespace.
  bool declared = true;
};

/// The meaning of `key` in a node of these types; a type may give a key another meaning.
[[nodiscard]] TermUse term(std::string_view key, const std::vector<std::string>& types = {});

/// The IRI of a class or individual: "Frame", "ldp:BasicContainer" or an absolute IRI.
[[nodiscard]] std::string class_iri(std::string_view name);

/// Every declared key with its IRI, and every prefix; for the writers and for tests.
[[nodiscard]] const std::vector<std::pair<std::string, TermUse>>& all_terms();
[[nodiscard]] const std::vector<rdf::Prefix>& all_prefixes();

}  // namespace chorus::resource
