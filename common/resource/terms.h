// The terms of our documents and their IRIs, as in proto/context.jsonld.
//
// There is one table, the context; it is compiled in and read once.  To add a term, add one line
// there and one paragraph in proto/vocab/chorus.ttl (a test compares the two).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/rdf/turtle_writer.h"

namespace chorus::resource {

inline constexpr std::string_view kChorus = "https://w3id.org/chorus-tracking/ns#";

enum class Container { None, Set, List, Index };

/// What one key means.
struct TermUse {
  std::string iri;
  std::string type = {};  ///< "@id", "@vocab", a datatype IRI, or empty: the type of the value.
  Container container = Container::None;
  std::string index = {};  ///< For Container::Index: IRI of the property that becomes the key.
  /// False: not in the context; the key is then a name in our namespace.
  bool declared = true;
};

/// The meaning of `key` in a node of these types (a type may give a key its own meaning).
[[nodiscard]] TermUse term(std::string_view key, const std::vector<std::string>& types = {});

/// The IRI of a class or individual: "Frame", "ldp:BasicContainer" or an absolute IRI.
[[nodiscard]] std::string class_iri(std::string_view name);

/// Every declared key with its IRI, and every prefix; for the writers and for tests.
[[nodiscard]] const std::vector<std::pair<std::string, TermUse>>& all_terms();
[[nodiscard]] const std::vector<rdf::Prefix>& all_prefixes();

}  // namespace chorus::resource
