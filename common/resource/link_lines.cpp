#include "common/resource/link_lines.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include "common/http/media_range.h"

namespace chorus::resource {
namespace {

constexpr std::string_view kJson = "application/json";
constexpr std::string_view kJsonLd = "application/ld+json";

std::string type_line(std::string_view type) {
  return "Link: <http://www.w3.org/ns/ldp#" + std::string(type) + ">; rel=\"type\"\r\n";
}

std::string lines_of(Kind kind) {
  if (kind == Kind::Other) return type_line("NonRDFSource");
  const std::string source = type_line("RDFSource") + "Link: </shapes>; rel=\"describedby\"\r\n";
  return kind == Kind::Container ? type_line("BasicContainer") + source : source;
}

/// The lines for one kind, without and with a link to the context of plain JSON; written once.
struct KindLines {
  std::string plain;
  std::string with_context;
};

const KindLines& kind_lines(Kind kind) {
  static const auto all = [] {
    std::array<KindLines, 3> lines;
    for (const Kind one : {Kind::Source, Kind::Container, Kind::Other}) {
      const std::string plain = lines_of(one);
      lines.at(static_cast<std::size_t>(one)) = {
          plain, plain +
                     "Link: </context.jsonld>; rel=\"http://www.w3.org/ns/json-ld#context\"; "
                     "type=\"application/ld+json\"\r\n"};
    }
    return lines;
  }();
  return all.at(static_cast<std::size_t>(kind));
}

bool is_of_type(const http::Variant& variant, std::string_view media_type) {
  return http::without_parameters(variant.media_type) == media_type;
}

}  // namespace

std::vector<http::Variant> linked(std::vector<http::Variant> variants, Kind kind) {
  const KindLines& lines = kind_lines(kind);
  const bool has_json_ld = std::ranges::any_of(
      variants, [](const http::Variant& one) { return is_of_type(one, kJsonLd); });
  for (http::Variant& variant : variants)
    variant.lines = has_json_ld && is_of_type(variant, kJson) ? lines.with_context : lines.plain;
  return variants;
}

http::DocumentPtr other_document(std::string media_type, std::string body,
                                 http::DocumentOptions options) {
  std::vector<http::Variant> variants;
  variants.push_back({std::move(media_type), [text = std::move(body)] { return text; }});
  return std::make_shared<const http::Document>(linked(std::move(variants), Kind::Other),
                                                std::move(options));
}

std::string_view link_lines(Kind kind) { return kind_lines(kind).plain; }

http::AnswerPolicy answer_policy() {
  return {.clock_field = std::string(kClockField),
          .resource_lines = type_line("Resource"),
          .lines = "Link: </openapi.json>; rel=\"service-desc\"\r\n",
          .realm = "chorus"};
}

}  // namespace chorus::resource
