// Small documents as a tree that is written in every format: /, /clock, /registration, /sensors/
// ...
//
// Keys are the terms of proto/context.jsonld ("captured", "verdict"); the context maps each to its
// IRI and datatype.  A key that is not there is written under our own namespace; undeclared_terms()
// finds those, and every builder has a test that there are none.  Frames do not go through here
// (frame_resource.h has their template).
//
// JSON: keys that end in "Nanoseconds" are strings.  A term with an index ("sensors", keyed by
// "sensorId") becomes an object, and each node's index property its key.
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

/// A decimal with this many fractional digits; left out when it is not finite.
struct Decimal {
  double value = 0.0;
  int digits = 4;
};

/// A string under a term of type @vocab ("verdict": "Good") names one of our individuals.
using Value =
    std::variant<bool, std::int64_t, Decimal, std::string, Timestamp, Ref, Node, std::vector<Node>,
                 std::vector<Ref>, std::vector<std::string>, std::vector<Decimal>>;

/// One subject: id "" is the document itself, "_" a blank node, else a relative or absolute IRI.
struct Node {
  std::string id;
  /// Terms ("Registration") or prefixed names ("ldp:BasicContainer").
  std::vector<std::string> types;
  std::vector<std::pair<std::string, Value>> properties;
};

/// The document as it stands at `place`.  Text that is not UTF-8 is made UTF-8.
[[nodiscard]] std::string write(const Node& node, Format format, const Place& place = {});

/// The document with all four formats, rendered on demand.
[[nodiscard]] http::DocumentPtr document_of(Node node, http::DocumentOptions options,
                                            Place place = {}, Kind kind = Kind::Source);

/// Its triples; relative IRIs stay relative.
[[nodiscard]] rdf::Graph graph_of(const Node& node);

/// Keys that proto/context.jsonld does not declare, in any depth.
[[nodiscard]] std::vector<std::string> undeclared_terms(const Node& node);

}  // namespace chorus::resource
