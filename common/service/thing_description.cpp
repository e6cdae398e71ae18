#include "common/service/thing_description.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/version.h"
#include "common/http/route_table.h"
#include "proto/embedded.h"

namespace chorus::service {
namespace {

using http::Method;
using nlohmann::json;

constexpr std::string_view kEvents = "text/event-stream";
constexpr std::string_view kJsonType = "application/json";

struct Writing {
  const char* key;  ///< In the OpenAPI document.
  const char* name;
  Method method;
};
constexpr std::array kWriting{
    Writing{"post", "POST", Method::Post}, Writing{"put", "PUT", Method::Put},
    Writing{"patch", "PATCH", Method::Patch}, Writing{"delete", "DELETE", Method::Delete}};

const json& contract() {
  static const json parsed = json::parse(proto::openapi_json());
  return parsed;
}

/// The value itself, or that to which its $ref leads within the contract.
const json& resolved(const json& value) {
  const auto reference = value.find("$ref");
  if (reference == value.end()) return value;
  const std::string pointer = reference->get<std::string>().substr(1);  // without '#'
  return contract().at(json::json_pointer(pointer));
}

/// "floorPlane" of the operation "getFloorPlane", "skeletons" of "listSkeletons".
std::string property_name(std::string operation) {
  for (const std::string_view verb : {"get", "list"}) {
    if (!operation.starts_with(verb)) continue;
    operation.erase(0, verb.size());
    operation[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(operation[0])));
    break;
  }
  return operation;
}

/// The parameters in the path, as TD calls them.
json variables_of(const json& item, const json& operation) {
  json variables = json::object();
  for (const json* owner : {&item, &operation}) {
    for (const json& listed : owner->value("parameters", json::array())) {
      const json& parameter = resolved(listed);
      if (parameter.at("in") != "path") continue;
      json& variable = variables[parameter.at("name").get<std::string>()];
      variable = {{"type", "string"}};
      if (parameter.contains("description")) variable["description"] = parameter["description"];
    }
  }
  return variables;
}

/// The media types of the answer with the lowest of these codes that the operation has.
std::vector<std::string> types_of(const json& operation) {
  std::vector<std::string> types;
  for (const char* code : {"200", "201", "202"}) {
    const auto answer = operation.at("responses").find(code);
    if (answer == operation.at("responses").end()) continue;
    const auto content = answer->find("content");
    if (content == answer->end()) break;
    for (const auto& [type, schema] : content->items()) types.push_back(type);
    break;
  }
  return types;
}

/// The JSON that the operation takes; null where it takes none, or its schema has parts elsewhere.
json input_of(const json& operation) {
  const auto body = operation.find("requestBody");
  if (body == operation.end()) return nullptr;
  const json& content = resolved(*body).at("content");
  const auto taken = content.find(kJsonType);
  if (taken == content.end() || !taken->contains("schema")) return nullptr;
  const json& schema = resolved(taken->at("schema"));
  return schema.dump().find("\"$ref\"") == std::string::npos ? schema : json(nullptr);
}

bool tagged(const json& operation, std::string_view tag) {
  const json tags = operation.value("tags", json::array());
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

/// Builds the description of one service.
class Thing {
 public:
  Thing(const Self& self, const ThingFacts& facts) : facts_(facts) {
    for (const Listed& one : all_resources(self)) listed_.insert("/" + one.path);
    thing_ = {{"@context",
               {"https://www.w3.org/2022/wot/td/v1.1",
                {{"ch", "https://w3id.org/chorus-tracking/ns#"},
                 {"htv", "http://www.w3.org/2011/http#"}}}},
              {"@type", json::array({"Thing", "ch:" + self.type})},
              {"title", self.title},
              {"description", self.description},
              {"version", {{"instance", version()}}},
              {"securityDefinitions", security_definitions()},
              {"security", json::array({reading()})},
              {"properties", json::object()},
              {"actions", json::object()},
              {"events", json::object()},
              {"links",
               {{{"rel", "service-desc"},
                 {"href", href("/openapi.json")},
                 {"type", "application/vnd.oai.openapi+json"}},
                {{"rel", "service-doc"}, {"href", href("/")}, {"type", "text/html"}}}}};
    if (!facts_.base.empty()) thing_["base"] = facts_.base;
  }

  void add(const std::string& path, const json& item, const http::Router::Entry& entry) {
    const auto get = item.find("get");
    if (get != item.end() && entry.readable() && offered(path) && !tagged(*get, "interface"))
      add_property(path, item, *get, entry);
    for (const Writing& writing : kWriting) {
      const auto operation = item.find(writing.key);
      if (operation != item.end() && entry.actions.contains(writing.method))
        add_action(path, item, *operation, writing);
    }
  }

  [[nodiscard]] std::string text() const {
    return thing_.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
  }

 private:
  [[nodiscard]] bool offered(const std::string& path) const {
    return path.find('{') != std::string::npos || listed_.contains(path);
  }

  /// Relative to the base or, where that is not known, to this document.  {name} in a path is a URI
  /// template (RFC 6570) as it stands.
  [[nodiscard]] std::string href(const std::string& path) const {
    return (facts_.base.empty() ? "../" : "") + (path == "/" ? "./" : path.substr(1));
  }

  [[nodiscard]] const char* reading() const { return facts_.guards_reading ? "read" : "nosec"; }

  static json security_definitions() {
    json definitions{{"nosec", {{"scheme", "nosec"}}}};
    for (const char* role : {"read", "images", "control"})
      definitions[role] = {{"scheme", "bearer"},
                           {"format", "opaque"},
                           {"in", "header"},
                           {"description", std::string("a token of the role ") + role +
                                               " or of one that allows more"}};
    return definitions;
  }

  /// A property or an event, without forms.
  static json affordance(const json& item, const json& operation) {
    json out{{"description", operation.at("summary")}, {"forms", json::array()}};
    if (json variables = variables_of(item, operation); !variables.empty())
      out["uriVariables"] = std::move(variables);
    return out;
  }

  /// `role`: what the form needs, if that is not what most need.
  void add_form(json& to, json form, const char* role) const {
    if (role != std::string_view(reading())) form["security"] = json::array({role});
    to["forms"].push_back(std::move(form));
  }

  void add_property(const std::string& path, const json& item, const json& operation,
                    const http::Router::Entry& entry) {
    const std::string name = property_name(operation.at("operationId"));
    const char* role = entry.for_everybody ? "nosec" : reading();
    if (entry.shows_people && facts_.guards_reading) role = "images";
    json property = affordance(item, operation);
    property["readOnly"] = true;
    for (const std::string& type : types_of(operation)) {
      if (type == kEvents) continue;
      add_form(property, {{"op", {"readproperty"}}, {"href", href(path)}, {"contentType", type}},
               role);
    }
    thing_["properties"][name] = std::move(property);
    if (!entry.live) return;
    json event = affordance(item, operation);
    event["data"] = {{"type", "object"}};
    add_form(event,
             {{"op", {"subscribeevent"}},
              {"href", href(path)},
              {"contentType", kEvents},
              {"subprotocol", "sse"}},
             role);
    thing_["events"][name] = std::move(event);
  }

  void add_action(const std::string& path, const json& item, const json& operation,
                  const Writing& writing) {
    json action = affordance(item, operation);
    action["safe"] = false;
    action["idempotent"] = writing.method != Method::Post;
    json form{{"op", {"invokeaction"}}, {"href", href(path)}, {"htv:methodName", writing.name}};
    const auto body = operation.find("requestBody");
    if (body != operation.end()) form["contentType"] = resolved(*body).at("content").begin().key();
    if (json input = input_of(operation); !input.is_null()) action["input"] = std::move(input);
    const auto types = types_of(operation);
    if (std::find(types.begin(), types.end(), kJsonType) != types.end())
      form["response"] = {{"contentType", kJsonType}};
    add_form(action, std::move(form), facts_.guards_writing ? "control" : reading());
    thing_["actions"][operation.at("operationId").get<std::string>()] = std::move(action);
  }

  const ThingFacts& facts_;
  std::set<std::string, std::less<>> listed_;
  json thing_;
};

}  // namespace

std::string thing_description(const Self& self, const http::Router& router,
                              const ThingFacts& facts) {
  Thing thing(self, facts);
  for (const auto& [path, item] : contract().at("paths").items()) {
    if (const auto* entry = router.entry_like(path)) thing.add(path, item, *entry);
  }
  return thing.text();
}

}  // namespace chorus::service
