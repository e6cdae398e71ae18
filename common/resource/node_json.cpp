#include "common/resource/node_json.h"

#include <cstdlib>

#include <nlohmann/json.hpp>

#include "common/resource/fixed_point.h"
#include "common/resource/terms.h"

namespace chorus::resource {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kIndent = 2;

Json object_of(const Node& node, bool linked, std::string_view without = {});

/// A value whose datatype the context does not declare: plain JSON contains only the value, JSON-LD
/// also the type.
Json typed(std::string text, std::string_view datatype, const TermUse& use, bool linked) {
  const std::string type = rdf::xsd(datatype);
  if (!linked || use.type == type) return text;
  return Json{{"@type", "xsd:" + std::string(datatype)}, {"@value", std::move(text)}};
}

/// Turns one value of a term into JSON.
struct ToJson {
  const std::string& key;
  const TermUse& use;
  bool linked;

  Json operator()(bool v) const { return v; }
  Json operator()(std::int64_t v) const {
    if (use.type == rdf::xsd("decimal")) return (*this)(Decimal{static_cast<double>(v), 1});
    const bool exact = v < kExactInteger && v > -kExactInteger;
    if (exact && !key.ends_with("Nanoseconds")) return v;
    return typed(std::to_string(v), "integer", use, linked);
  }
  Json operator()(const Decimal& v) const {
    auto text = fixed(v.value, v.digits);
    if (!text) return nullptr;
    if (linked) return typed(*std::move(text), "decimal", use, linked);
    return std::strtod(text->c_str(), nullptr);
  }
  Json operator()(const std::string& v) const { return v; }
  Json operator()(Timestamp v) const { return typed(to_iso8601(v), "dateTime", use, linked); }
  Json operator()(const Ref& v) const {
    if (use.type == "@id" || !linked) return v.iri;
    return Json{{"@id", v.iri}};
  }
  Json operator()(const Node& v) const { return (*this)(std::vector<Node>{v}, false); }
  Json operator()(const std::vector<Node>& v) const { return (*this)(v, true); }
  Json operator()(const std::vector<Node>& nodes, bool many) const {
    if (use.container == Container::Index) return indexed(nodes);
    if (!many && use.container == Container::None) return object_of(nodes.front(), linked);
    Json all = Json::array();
    for (const Node& node : nodes) all.push_back(object_of(node, linked));
    return all;
  }
  template <class Item>
  Json operator()(const std::vector<Item>& items) const {
    Json all = Json::array();
    for (const Item& item : items) {
      if (Json one = (*this)(item); !one.is_null()) all.push_back(std::move(one));
    }
    return all;
  }

  /// The nodes as {"s1": {...}, "s2": {...}}: the value of the index property becomes the key.
  [[nodiscard]] Json indexed(const std::vector<Node>& nodes) const {
    Json all = Json::object();
    for (const Node& node : nodes) {
      for (const auto& [name, value] : node.properties) {
        const auto* text = std::get_if<std::string>(&value);
        if (text != nullptr && term(name, node.types).iri == use.index) {
          all[*text] = object_of(node, linked, name);
        }
      }
    }
    return all;
  }
};

Json object_of(const Node& node, bool linked, std::string_view without) {
  Json object = Json::object();
  if (node.id != "_") object["@id"] = node.id;
  if (node.types.size() == 1) object["@type"] = node.types.front();
  if (node.types.size() > 1) object["@type"] = node.types;
  for (const auto& [key, value] : node.properties) {
    if (key == without) continue;
    const TermUse use = term(key, node.types);
    Json json = std::visit(ToJson{key, use, linked}, value);
    if (!json.is_null()) object[key] = std::move(json);
  }
  return object;
}

}  // namespace

std::string to_json(const Node& node, bool linked, const Place& place) {
  Json object = Json::object();
  if (linked) object["@context"] = place.up() + "context.jsonld";
  object.update(object_of(node, linked));
  return object.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace chorus::resource
