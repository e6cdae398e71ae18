#include "common/resource/flat_reader.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/json.h"
#include "common/rdf/turtle_reader.h"
#include "common/resource/decimal_reader.h"
#include "common/resource/terms.h"

namespace chorus::resource {
namespace {

tl::unexpected<Error> not_a(std::string_view type) {
  return fail(ErrorCode::Malformed, {}, "the document holds no ch:" + std::string(type));
}

Result<Properties> from_json(std::string_view bytes, std::string_view type) {
  const auto json = parse_json(bytes);
  if (!json) return pass(json);
  if (!json->is_object() || json->value("@type", nlohmann::json()) != type) return not_a(type);
  Properties properties;
  for (const auto& [key, value] : json->items()) {
    if (key.starts_with('@') || value.is_structured() || value.is_null()) continue;
    properties[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return properties;
}

/// The only subject of this type; nullopt when none or several have it.
std::optional<rdf::Term> subject_of(const rdf::Graph& graph, std::string_view type) {
  std::optional<rdf::Term> subject;
  for (const rdf::Triple& triple : graph) {
    if (triple.predicate.value != rdf::rdf("type") || triple.object.value != class_iri(type))
      continue;
    if (subject && *subject != triple.subject) return std::nullopt;
    subject = triple.subject;
  }
  return subject;
}

Result<Properties> from_rdf(std::string_view bytes, Format format, std::string_view type) {
  rdf::ReadOptions options;
  options.syntax = format == Format::NTriples ? rdf::Syntax::NTriples : rdf::Syntax::Turtle;
  const auto graph = rdf::read_graph(bytes, options);
  if (!graph) return pass(graph);
  const auto subject = subject_of(*graph, type);
  if (!subject) return not_a(type);
  Properties properties;
  for (const rdf::Triple& triple : *graph) {
    if (triple.subject != *subject || !triple.predicate.value.starts_with(kChorus)) continue;
    const std::string key = triple.predicate.value.substr(kChorus.size());
    const bool named = triple.object.value.starts_with(kChorus);
    if (triple.object.kind != rdf::TermKind::Literal && !named) continue;
    std::string value = named ? triple.object.value.substr(kChorus.size()) : triple.object.value;
    if (!properties.emplace(key, value).second && properties[key] != value) {
      return fail(ErrorCode::Malformed, "ch:" + key, "is given twice, with different values");
    }
  }
  return properties;
}

}  // namespace

Result<Properties> read_properties(std::string_view bytes, Format format, std::string_view type) {
  const bool json = format == Format::Json || format == Format::JsonLd;
  return json ? from_json(bytes, type) : from_rdf(bytes, format, type);
}

Result<double> number_of(const Properties& properties, std::string_view key) {
  const auto found = properties.find(key);
  if (found == properties.end())
    return fail(ErrorCode::Malformed, "ch:" + std::string(key), "is missing");
  const auto value = read_decimal(found->second);
  if (!value) return fail(ErrorCode::Malformed, "ch:" + std::string(key), "is no finite number");
  return *value;
}

}  // namespace chorus::resource
