// The formats in which resources that are RDF are written.
#pragma once

#include <array>
#include <string_view>

namespace chorus::resource {

enum class Format { Turtle, JsonLd, Json, NTriples };

inline constexpr std::array kFormats{Format::Turtle, Format::JsonLd, Format::Json,
                                     Format::NTriples};

[[nodiscard]] constexpr std::string_view media_type(Format format) noexcept {
  switch (format) {
    case Format::Turtle:
      return "text/turtle";
    case Format::JsonLd:
      return "application/ld+json";
    case Format::Json:
      return "application/json";
    case Format::NTriples:
      return "application/n-triples";
  }
  return "text/turtle";
}

}  // namespace chorus::resource
