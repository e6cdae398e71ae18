// Rare documents as a small tree that writes itself in every format: /, /clock, /registration, /sensors/ ...
//
// Keys are the terms of proto/context.jsonld ("captured", "verdict"); the term table maps each to its IRI and
// datatype.  An unknown key asserts in tests and is written under our own namespace.  Frames do not go
// through here (frame_resource.h has their template).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/http/document.h"
#include "common/resource/media_type.h"
#include "common/time/timestamp.h"

namespace chorus::resource {

struct Node;

/// An IRI reference, relative to the document ("skeletons/7") or absolute.
struct Ref {
  std::string iri;
};

/// A decimal with so many fractional digits; not finite: the property is left out.
struct Decimal {
  double value = 0.0;
  int digits = 4;
};

using Value = std::variant<bool, std::int64_t, Decimal, std::string, Timestamp, Ref, Node,
                           std::vector<Node>, std::vector<Ref>, std::vector<std::string>>;

/// One subject: id "" is the document itself, "_" a blank node, else a relative or absolute IRI.
struct Node {
  std::string id;
  std::vector<std::string> types;  ///< Terms ("Registration") or prefixed names ("ldp:BasicContainer").
  std::vector<std::pair<std::string, Value>> properties;
};

[[nodiscard]] std::string write(const Node& node, Format format);

/// The document with all four formats, rendered on demand.
[[nodiscard]] http::DocumentPtr document_of(Node node, http::DocumentOptions options);

}  // namespace chorus::resource
