// Context, OpenAPI, the schema of recordings, and the table of the README.
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/contract/contract_text.h"
#include "tests/contract/field_terms.h"

namespace chorus::contract {
namespace {

using Json = nlohmann::ordered_json;
using resource::FieldKind;

constexpr const char* kNamePattern = "^[A-Za-z0-9_-]{1,64}$";

Json whole(const Term& term) {
  Json value{{"type", "integer"}, {"minimum", 0}};
  if (term.row.most > 0) value["maximum"] = static_cast<std::int64_t>(term.row.most);
  return value;
}

Json number_with_limits(const Term& term) {
  return Json{{"type", "number"}, {"minimum", term.least()}, {"maximum", term.row.most}};
}

Json number_of_openapi(const Term&) { return Json{{"$ref", "#/components/schemas/Decimal"}}; }

Json list(const Term& term, const Json& number) {
  return Json{
      {"type", "array"}, {"minItems", term.size}, {"maxItems", term.size}, {"items", number}};
}

/// Puts what the table says of a class into its properties.
void put_properties(Json& properties, const std::string& owner, Json (*number)(const Term&)) {
  for (const Term& term : field_terms()) {
    if (!term.of(owner)) continue;
    Json value = number(term);
    if (term.kind == FieldKind::Whole) value = whole(term);
    if (term.kind == FieldKind::Name) value = Json{{"type", "string"}, {"pattern", kNamePattern}};
    if (term.kind == FieldKind::List) value = list(term, value);
    if (term.first()) value["description"] = term.comment(true);
    properties[term.name] = value;
  }
}

std::string type_of(const Term& term) {
  if (term.is_number() || term.kind == FieldKind::List) return "xsd:decimal";
  return term.kind == FieldKind::Whole ? "xsd:integer" : "";
}

/// Replaces the line that begins with `start`; a new one goes behind `after`, the last that was
/// put.
void put_line(std::string& text, std::size_t& after, const std::string& start,
              const std::string& rest) {
  const std::size_t at = text.find("\n" + start);
  const std::string line = start + rest;
  const std::size_t from = at == std::string::npos ? after : at + 1;
  const std::size_t to = at == std::string::npos ? after : text.find('\n', from) + 1;
  text.replace(from, to - from, line + "\n");
  after = from + line.size() + 1;
}

std::string readable_unit(std::string_view unit) {
  for (const auto& [code, text] : {std::pair{"M", "m"},
                                   {"M2", "m²"},
                                   {"SEC", "s"},
                                   {"M-PER-SEC", "m/s"},
                                   {"M2-PER-SEC2", "m²/s²"},
                                   {"RAD2", "rad²"}}) {
    if (unit == code) return std::string(" [") + text + "]";
  }
  return {};
}

/// ", of a body or joint"
std::string owners_of(const Term& term) {
  std::string owners;
  for (const auto& [owner, word] :
       {std::pair{"Frame", "frame"}, {"Skeleton", "body"}, {"Joint", "joint"}}) {
    const bool of_frame = std::string_view(owner) == "Skeleton" && term.of("Frame");
    if (term.of(owner) && !of_frame) owners += std::string(owners.empty() ? "" : " or ") + word;
  }
  return ", of a " + owners;
}

std::string readable_type(const Term& term) {
  if (term.kind == FieldKind::Name) return "name of `[A-Za-z0-9_-]`" + owners_of(term);
  if (term.kind == FieldKind::List)
    return "list of " + std::to_string(term.size) + " decimals" + readable_unit(term.row.unit) +
           owners_of(term);
  const std::string many = term.group.size() > 1 ? "s" : "";
  const std::string type = term.is_number() ? "decimal" + many : "integer";
  const bool limited = term.group.size() == 1 && term.row.most > 0;
  return type + readable_unit(term.row.unit) +
         (limited ? ", " + short_number(term.least()) + " to " + short_number(term.row.most) : "") +
         owners_of(term);
}

}  // namespace

std::string with_context(const std::string& text) {
  std::string out = text;
  std::size_t after = out.find('\n', out.find("\n    \"space\":") + 1) + 1;
  for (const Term& term : field_terms()) {
    std::string type = type_of(term).empty() ? "" : ", \"@type\": \"" + type_of(term) + "\"";
    if (term.kind == FieldKind::List) type += ", \"@container\": \"@list\"";
    put_line(out, after,
             "    \"" + term.name + "\":", " { \"@id\": \"ch:" + term.name + "\"" + type + " },");
  }
  return out;
}

std::string with_openapi(const std::string& text) {
  Json document = Json::parse(text);
  Json& schemas = document["components"]["schemas"];
  put_properties(schemas["Frame"]["properties"], "Frame", number_of_openapi);
  put_properties(schemas["Frame"]["properties"]["bodies"]["items"]["properties"], "Skeleton",
                 number_of_openapi);
  put_properties(schemas["Skeleton"]["properties"], "Skeleton", number_of_openapi);
  put_properties(schemas["Joint"]["properties"], "Joint", number_of_openapi);
  return document.dump(1) + "\n";
}

std::string with_schema(const std::string& text) {
  Json document = Json::parse(text);
  put_properties(document["properties"], "Frame", number_with_limits);
  // Only now, because a new entry moves the others.
  Json& body = document["properties"]["bodies"]["items"]["properties"];
  put_properties(body, "Skeleton", number_with_limits);
  put_properties(body["joints"]["additionalProperties"]["properties"], "Joint", number_with_limits);
  return document.dump(1) + "\n";
}

std::string with_readme(const std::string& text) {
  std::string out = text;
  std::size_t after = out.find('\n', out.find("\n| `ch:state`") + 1) + 1;
  for (const Term& term : field_terms()) {
    if (!term.first()) continue;
    std::string rest;
    for (std::size_t i = 1; i < term.group.size(); ++i) rest += ", `ch:" + term.group[i] + "`";
    put_line(out, after, "| `ch:" + term.name + "`",
             rest + " | " + (term.group.size() > 1 ? "the same" : "`" + term.name + "`") + " | " +
                 readable_type(term) + " | " + term.comment(true) + " |");
  }
  return out;
}

}  // namespace chorus::contract
