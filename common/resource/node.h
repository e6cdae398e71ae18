// Small documents as a tree that can be written in every format: /, /clock, /registration,
// /sensors/ ...
//
// Keys are the terms of proto/context.jsonld ("captured", "verdict"); the context maps each term to
// its IRI and datatype.  A key that the context lacks is written in our own namespace;
// undeclared_terms() finds such keys, and a test of every builder requires that there are none.
// Frames do not use this; frame_resource.h writes them from templates.
//
// In JSON, the values of keys that end in "Nanoseconds" are strings.  A term with an index (such as
// "sensors", by "sensorId") becomes an object: the index property of each node is its key.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/http/document.h"
#include "common/rdf/term.h"
#include "common/resource/link_lines.h"
#include "common/resource/media_type.h"
#include "common/resource/place.h"
#include "common/time/timestamp.h"

namespace chorus::resource {

struct Node;

/// An IRI reference, relative to the document ("skeletons/7") or absolute.
struct Ref {
  std::string iri;
};

/// A decimal with this many fractional digits; omitted when it is not finite or beyond 1e15.
struct Decimal {
  double value = 0.0;
  int digits = 4;
};

/// The value of a property.  A string for a term of type @vocab ("verdict": "Good") names one of
/// our individuals.
using Value =
    std::variant<bool, std::int64_t, Decimal, std::string, Timestamp, Ref, Node, std::vector<Node>,
                 std::vector<Ref>, std::vector<std::string>, std::vector<Decimal>>;

/// One subject: id "" is the document itself, "_" a blank node, anything else a relative or
/// absolute IRI.
struct Node {
  std::string id;
  /// Terms ("Registration") or prefixed names ("ldp:BasicContainer").
  std::vector<std::string> types;
  std::vector<std::pair<std::string, Value>> properties;
};

/// The document at its `place`.  In strings, what is not UTF-8 is replaced.
[[nodiscard]] std::string write(const Node& node, Format format, const Place& place = {});

/// The document in all four formats, each rendered on demand.
[[nodiscard]] http::DocumentPtr document_of(Node node, http::DocumentOptions options,
                                            Place place = {}, Kind kind = Kind::Source);

/// The triples of the tree; relative IRIs stay relative.
[[nodiscard]] rdf::Graph graph_of(const Node& node);

/// All keys, at any depth, that proto/context.jsonld does not declare and that have no prefix.
[[nodiscard]] std::vector<std::string> undeclared_terms(const Node& node);

}  // namespace chorus::resource
