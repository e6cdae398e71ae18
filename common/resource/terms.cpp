#include "common/resource/terms.h"

#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "proto/embedded.h"

namespace chorus::resource {
namespace {

using Json = nlohmann::ordered_json;

/// proto/context.jsonld, in the shape that a test guarantees: prefixes are strings, terms are
/// objects with "@id", and a term with "@context" is a type that scopes further terms.
class Context {
 public:
  Context() {
    const Json context = Json::parse(proto::context()).at("@context");
    for (const auto& [key, value] : context.items()) {
      if (value.is_string() && !key.starts_with('@')) {
        prefixes_.emplace_back(key, value.get<std::string>());
      }
    }
    for (const auto& [key, value] : context.items()) {
      if (!value.is_object()) continue;
      if (value.contains("@context")) {
        for (const auto& [inner, use] : value.at("@context").items()) {
          scoped_[key][inner] = use_of(use);
          all_.emplace_back(inner, use_of(use));
        }
      } else {
        terms_[key] = use_of(value);
        all_.emplace_back(key, use_of(value));
      }
    }
  }

  static const Context& own() {
    static const Context context;
    return context;
  }

  [[nodiscard]] std::string expand(std::string_view name) const {
    const std::size_t colon = name.find(':');
    if (colon == std::string_view::npos) return std::string(kChorus).append(name);
    for (const auto& [prefix, space] : prefixes_) {
      if (name.substr(0, colon) == prefix) return space + std::string(name.substr(colon + 1));
    }
    return std::string(name);
  }

  [[nodiscard]] const TermUse* find(std::string_view key,
                                    const std::vector<std::string>& types) const {
    for (const std::string& type : types) {
      const auto scope = scoped_.find(type);
      if (scope == scoped_.end()) continue;
      if (const auto found = scope->second.find(key); found != scope->second.end())
        return &found->second;
    }
    const auto found = terms_.find(key);
    return found == terms_.end() ? nullptr : &found->second;
  }

  [[nodiscard]] const auto& all() const { return all_; }
  [[nodiscard]] const auto& prefixes() const { return prefixes_; }

 private:
  using Table = std::map<std::string, TermUse, std::less<>>;

  [[nodiscard]] TermUse use_of(const Json& definition) const {
    TermUse use;
    use.iri = expand(definition.at("@id").get<std::string>());
    const auto type = definition.value("@type", std::string());
    use.type = type.starts_with('@') || type.empty() ? type : expand(type);
    const auto container = definition.value("@container", std::string());
    if (container == "@set") use.container = Container::Set;
    if (container == "@list") use.container = Container::List;
    if (container == "@index") {
      use.container = Container::Index;
      use.index = expand(definition.value("@index", std::string()));
    }
    return use;
  }

  std::vector<rdf::Prefix> prefixes_;
  Table terms_;
  std::map<std::string, Table, std::less<>> scoped_;
  std::vector<std::pair<std::string, TermUse>> all_;
};

}  // namespace

TermUse term(std::string_view key, const std::vector<std::string>& types) {
  const Context& context = Context::own();
  if (const TermUse* found = context.find(key, types)) return *found;
  TermUse use;
  use.iri = context.expand(key);
  use.declared = key.find(':') != std::string_view::npos;
  return use;
}

std::string class_iri(std::string_view name) { return Context::own().expand(name); }

const std::vector<std::pair<std::string, TermUse>>& all_terms() { return Context::own().all(); }

const std::vector<rdf::Prefix>& all_prefixes() { return Context::own().prefixes(); }

}  // namespace chorus::resource
