// What linked data adds to HTTP answers: Link header lines, and how a service describes itself.
#pragma once

#include <string_view>
#include <vector>

#include "common/http/answer_policy.h"
#include "common/http/document.h"

namespace chorus::resource {

/// What kind of resource a document is (LDP 1.0, 4.2.1.4 and 5.2.1.4).
enum class Kind {
  Source,     ///< It says something in RDF.
  Container,  ///< It also lists other resources.
  Other,      ///< An image, a page, a file.
};

/// Gives every variant its Link header lines: its kind, where its shapes are, and, for plain JSON
/// beside JSON-LD, the context that makes it JSON-LD (JSON-LD 1.1, 6.1).
[[nodiscard]] std::vector<http::Variant> linked(std::vector<http::Variant> variants, Kind kind);

/// A document with one fixed representation that is not RDF.
[[nodiscard]] http::DocumentPtr other_document(std::string media_type, std::string body,
                                               http::DocumentOptions options);

/// The Link header lines of a kind.
[[nodiscard]] std::string_view link_lines(Kind kind);

/// The header field that tells a service's clock (proto/README.md).
inline constexpr std::string_view kClockField = "Chorus-Clock";

/// What every answer of a Chorus service carries: Chorus-Clock, its type, the service's
/// description.
[[nodiscard]] http::AnswerPolicy answer_policy();

}  // namespace chorus::resource
