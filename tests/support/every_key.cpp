#include "tests/support/every_key.h"

#include <nlohmann/json.hpp>

namespace chorus::testing {
namespace {

using nlohmann::json;

/// Values to try for a key that holds a string; each is valid for some key.
constexpr const char* kWords[] = {"s2",          "0.0.0.0",
                                  "http://a",    "warn",
                                  "json",        "A",
                                  "circle",      "replay",
                                  "otto",        "centre-axis",
                                  "icp-only",    "when-accepted",
                                  "neck",        "shoulders",
                                  "as-recorded", "powerwall",
                                  "predicted",   "global",
                                  "multicast",   "metres",
                                  "ForearmLeft", "239.1.2.3",
                                  "tcp",         "/tmp/x.bvh",
                                  "10.0.0.1",    "tests/unit/learn/head_model.json",
                                  "network",     "landmarks",
                                  "mixtures"};

std::vector<json> other_values(const json& value) {
  std::vector<json> others;
  if (value.is_boolean()) others.emplace_back(!value.get<bool>());
  if (value.is_number_integer()) {
    for (const int step : {1, -1, 100, -7}) others.emplace_back(value.get<std::int64_t>() + step);
  }
  if (value.is_number()) {
    for (const double factor : {0.9, 1.1}) others.emplace_back(value.get<double>() * factor);
    others.emplace_back(0.01);
  }
  if (value.is_string()) {
    others.assign(std::begin(kWords), std::end(kWords));
  }
  if (value.is_array()) {
    others.push_back(json::array());
    others.push_back(json::array({"127.0.0.1:7"}));
    others.push_back(json::array({"127.0.0.1"}));
    others.push_back(json::array({json{{"id", "one"}, {"url", "http://127.0.0.1:7/"}}}));
    others.push_back(json::array({json{{"hand", "right.json"}}}));
    others.push_back(json::array({json{{"tracker", 8}, {"prop", "driver"}}}));
    others.push_back(json::parse(R"([{"kind": "pillar"}])"));
    others.push_back(json::parse(R"([{"token": "0123456789abcdef", "role": "images"}])"));
    others.push_back(json::parse(R"([{"between": ["s1", "s2"], "m": 4.31}])"));
    others.push_back(json::parse(R"([{"name": "cam01"}])"));
    others.push_back(json::parse(R"([{"kind": "silence", "limb": "Pelvis", "begin_s": 3}])"));
    others.push_back(json::parse(R"([{"slot": 1, "targets": ["127.0.0.1:7"]}])"));
  }
  std::erase(others, value);  // a factor does not change zero
  return others;
}

void add_leaves(const json& value, const json::json_pointer& at,
                std::vector<json::json_pointer>& out) {
  if (!value.is_object()) return out.push_back(at);
  for (const auto& [key, inner] : value.items()) add_leaves(inner, at / key, out);
}

std::string dotted(const json::json_pointer& at) {
  std::string text = at.to_string().substr(1);
  for (char& c : text) c = c == '/' ? '.' : c;
  return text;
}

}  // namespace

std::vector<ChangedKey> every_key_changed(
    std::string_view text, const std::function<bool(const std::string& text)>& accepted) {
  constexpr bool kExceptions = true;
  constexpr bool kComments = true;
  const json whole = json::parse(text, nullptr, kExceptions, kComments);
  std::vector<json::json_pointer> leaves;
  add_leaves(whole, json::json_pointer(), leaves);
  std::vector<ChangedKey> all;
  for (const json::json_pointer& leaf : leaves) {
    all.push_back({dotted(leaf), {}});
    for (const json& other : other_values(whole.at(leaf))) {
      json changed = whole;
      changed[leaf] = other;
      if (!accepted(changed.dump())) continue;
      all.back().text = changed.dump();
      break;
    }
  }
  return all;
}

}  // namespace chorus::testing
