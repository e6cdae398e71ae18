#include "common/resource/json_guard.h"

#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace chorus::resource {
namespace {

using Json = nlohmann::json;

/// Deepest nesting of the text, strings aside.
int depth_of(std::string_view text) {
  int depth = 0;
  int deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

/// Sees every key as it is parsed; remembers the first that its object has twice.
class KeyWatch {
 public:
  bool operator()(int, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) open_.emplace_back();
    if (event == Json::parse_event_t::object_end && !open_.empty()) open_.pop_back();
    if (event == Json::parse_event_t::key && !open_.empty()) {
      const auto& key = parsed.get_ref<const std::string&>();
      if (!open_.back().insert(key).second && repeated_.empty()) repeated_ = key;
    }
    return true;
  }
  [[nodiscard]] const std::string& repeated() const { return repeated_; }

 private:
  std::vector<std::set<std::string>> open_;
  std::string repeated_;
};

}  // namespace

Result<Json> parse_json(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.bytes) {
    return fail(ErrorCode::TooLarge, {},
                "the document has " + std::to_string(text.size()) + " bytes; at most " +
                    std::to_string(limits.bytes) + " are read");
  }
  if (depth_of(text) > limits.nesting) {
    return fail(ErrorCode::TooLarge, {},
                "brackets are nested deeper than " + std::to_string(limits.nesting));
  }
  KeyWatch watch;
  try {
    Json json = Json::parse(text, [&watch](int depth, Json::parse_event_t event, Json& parsed) {
      return watch(depth, event, parsed);
    });
    if (watch.repeated().empty()) return json;
  } catch (const Json::exception& error) {
    return fail(ErrorCode::Malformed, {}, error.what());
  }
  return fail(ErrorCode::Malformed, watch.repeated().substr(0, 80), "the key is given twice");
}

}  // namespace chorus::resource
