// What linked data adds to HTTP answers: Link header lines, and a link to the self-description.
#pragma once

#include <string_view>
#include <vector>

#include "common/http/answer_policy.h"
#include "common/http/document.h"

namespace chorus::resource {

/// What kind of resource a document is (LDP 1.0, 4.2.1.4 and 5.2.1.4).
enum class Kind {
  Source,     ///< An RDF document.
  Container,  ///< An RDF document that lists other resources.
  Other,      ///< Not RDF: an image, a page, a file.
};

/// Gives every variant its Link header lines: its kind, the place of its shapes and, for plain JSON
/// next to JSON-LD, the context that makes it JSON-LD (JSON-LD 1.1, 6.1).
[[nodiscard]] std::vector<http::Variant> linked(std::vector<http::Variant> variants, Kind kind);

/// A document with one fixed representation that is not RDF.
[[nodiscard]] http::DocumentPtr other_document(std::string media_type, std::string body,
                                               http::DocumentOptions options);

/// The Link header lines for a kind.
[[nodiscard]] std::string_view link_lines(Kind kind);

/// The header field that states a service's clock (proto/README.md).
inline constexpr std::string_view kClockField = "Chorus-Clock";

/// What answers of a Chorus service have in addition: the field Chorus-Clock, a Link line to the
/// service's description and, for known paths, one to their type.
[[nodiscard]] http::AnswerPolicy answer_policy();

}  // namespace chorus::resource
