#include "common/base/config_reader.h"

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/log.h"
#include "common/base/nearest.h"
#include "common/base/parse.h"
#include "common/base/shortened.h"
#include "common/base/units.h"

namespace chorus {
namespace {

using nlohmann::json;

constexpr JsonLimits kLimits{.bytes = 1024 * 1024, .nesting = 16, .comments = true};
/// Limits the length of arrays, and the array index in --set.
constexpr std::size_t kMaxArrayLength = 4096;
constexpr std::size_t kShownCharacters = 80;  ///< Limit for quoting a wrong value [bytes].
constexpr double kMillisecondsPerSecond = 1e3;

/// What is wrong with a value; names the key that was given twice, if any.
std::string reason_of(const Error& error) {
  return error.context.empty() ? error.message : "'" + error.context + "': " + error.message;
}

std::string shown(std::string_view text) { return shortened(text, kShownCharacters); }

std::string dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Whether the value of a key, or of an item of a list, is a token.
bool is_secret(std::string_view path) {
  while (!path.empty() && (path.back() == '.' || (path.back() >= '0' && path.back() <= '9')))
    path.remove_suffix(1);
  return path.ends_with("token") || path.ends_with("tokens");
}

/// How errors, which end up in logs, quote the wrong value of a key.  Never shows a token, nor what
/// may contain some.
std::string shown_json(std::string_view path, const json& value) {
  if (value.is_array()) return "a list";
  if (value.is_object()) return "an object";
  return is_secret(path) ? "what is there" : shown(dumped(value));
}

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

std::string range_text(double least, double most) {
  return "from " + log::number_text(least) + " to " + log::number_text(most);
}

/// The array index that `part` spells; none if it is no such number, or too large.
std::optional<std::size_t> index_in(std::string_view part) {
  const auto index = parse_number<std::size_t>(part);
  return index && *index < kMaxArrayLength ? index : std::nullopt;
}

/// The place that a --set path names, created if missing; null if the path is malformed or too
/// deep, or if it leads through a value that cannot contain the rest of it.
json* place_at(json& root, std::string_view path) {
  json* at = &root;
  int depth = 0;
  while (at != nullptr) {
    const std::size_t dot = path.find('.');
    const std::string_view part = path.substr(0, dot);
    const std::optional<std::size_t> index = index_in(part);
    if (part.empty() || ++depth > kLimits.nesting) return nullptr;
    if (at->is_null()) *at = index ? json::array() : json::object();
    if (at->is_array() && index && *index <= at->size()) {
      if (*index == at->size()) at->push_back(nullptr);
      at = &(*at)[*index];
    } else {
      at = at->is_object() ? &(*at)[std::string(part)] : nullptr;
    }
    if (dot == std::string_view::npos) return at;
    path.remove_prefix(dot + 1);
  }
  return nullptr;
}

}  // namespace

struct ConfigReader::Node {
  json value = json::object();
  std::string path;  ///< "sensors.0"; empty at the root
  std::shared_ptr<std::vector<std::string>> problems;
  std::string origin;                        ///< Set only at the root.
  std::set<std::string, std::less<>> known;  ///< Every key that the caller read.
  std::map<std::string, std::shared_ptr<Node>> children;

  /// The value at a key, null when the key is absent.  From now on the key counts as known.
  const json* find(std::string_view key) {
    known.emplace(key);
    const auto found = value.find(std::string(key));
    return found == value.end() ? nullptr : &*found;
  }

  void complain(std::string_view key, const std::string& message) const {
    problems->push_back(joined(path, key) + ": " + message);
  }

  /// For example: "port: must be a whole number, not "x"".
  void complain_type(std::string_view key, std::string_view wanted, const json& got) const {
    complain(key, "must be " + std::string(wanted) + ", not " + shown_json(joined(path, key), got));
  }

  std::shared_ptr<Node> nested(const std::string& key, const json& inner) {
    std::shared_ptr<Node>& child = children[key];
    if (!child) {
      child = std::make_shared<Node>();
      child->value = inner;
      child->path = joined(path, key);
      child->problems = problems;
    }
    return child;
  }

  void list_unknown(std::vector<std::string>& out) const {
    const std::vector<std::string> names(known.begin(), known.end());
    for (const auto& [key, unused] : value.items()) {
      if (known.contains(key)) continue;
      const std::string meant = nearest(key, names);
      out.push_back(joined(path, shown(key)) + ": unknown key" +
                    (meant.empty() ? "" : "; did you mean '" + meant + "'?"));
    }
    for (const auto& [key, child] : children) child->list_unknown(out);
  }
};

Result<ConfigReader> ConfigReader::parse(std::string_view text, std::string_view origin) {
  if (text.size() > kLimits.bytes) {
    return fail(ErrorCode::TooLarge, std::string(origin), "a config file has at most 1 MiB");
  }
  auto value = parse_json(text, kLimits);
  if (!value) return fail(ErrorCode::Malformed, std::string(origin), reason_of(value.error()));
  auto node = std::make_shared<Node>();
  node->origin = origin;
  node->problems = std::make_shared<std::vector<std::string>>();
  node->value = std::move(*value);
  if (!node->value.is_object()) {
    return fail(ErrorCode::Malformed, std::string(origin), "must be one JSON object: { ... }");
  }
  return ConfigReader(std::move(node));
}

Result<void> ConfigReader::set(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string context = "--set " + shown(assignment.substr(0, equals));
  if (equals == std::string_view::npos || equals == 0) {
    return fail(ErrorCode::InvalidArgument, context, "write it as path=value, such as port=8082");
  }
  const std::string_view text = assignment.substr(equals + 1);
  auto parsed = parse_json(text, kLimits);
  if (!parsed) {
    // A text such as 127.0.0.1 needs no quotes, but a broken list, object or quoted text is a
    // mistake.
    if (!text.empty() && std::string_view("[{\"").find(text.front()) != std::string_view::npos)
      return fail(ErrorCode::Malformed, context, reason_of(parsed.error()));
  }
  json value = parsed ? std::move(*parsed) : json(std::string(text));
  json* place = place_at(node_->value, assignment.substr(0, equals));
  if (place == nullptr) {
    return fail(ErrorCode::InvalidArgument, context,
                "the path must name object keys and existing list positions (or the next one)");
  }
  *place = std::move(value);
  return {};
}

void ConfigReader::read(std::string_view key, bool& out) {
  const json* value = node_->find(key);
  if (value == nullptr) return;
  if (!value->is_boolean()) return node_->complain_type(key, "true or false", *value);
  out = value->get<bool>();
}

void ConfigReader::read(std::string_view key, int& out, int least, int most) {
  const json* value = node_->find(key);
  if (value == nullptr) return;
  if (!value->is_number_integer()) return node_->complain_type(key, "a whole number", *value);
  const double wide = value->get<double>();  // exact for every int; larger numbers stay too large
  if (wide < least || wide > most) {
    return node_->complain_type(key, range_text(least, most), *value);
  }
  out = value->get<int>();
}

void ConfigReader::read(std::string_view key, double& out, double least, double most) {
  const json* value = node_->find(key);
  if (value == nullptr) return;
  if (!value->is_number()) return node_->complain_type(key, "a number", *value);
  const double number = value->get<double>();
  if (!(number >= least && number <= most)) {
    return node_->complain_type(key, range_text(least, most), *value);
  }
  out = number;
}

void ConfigReader::read(std::string_view key, std::string& out) {
  const json* value = node_->find(key);
  if (value == nullptr) return;
  if (!value->is_string()) return node_->complain_type(key, "a text in quotes", *value);
  out = value->get<std::string>();
}

void ConfigReader::read(std::string_view key, std::vector<double>& out) {
  const json* value = node_->find(key);
  if (value == nullptr) return;
  std::vector<double> numbers;
  bool good = value->is_array() && value->size() <= kMaxArrayLength;
  for (std::size_t i = 0; good && i < value->size(); ++i) {
    good = (*value)[i].is_number();
    if (good) numbers.push_back((*value)[i].get<double>());
  }
  if (!good) return node_->complain_type(key, "a list of numbers", *value);
  out = std::move(numbers);
}

void ConfigReader::read(std::string_view key, std::vector<std::string>& out) {
  const json* value = node_->find(key);
  if (value == nullptr) return;
  std::vector<std::string> texts;
  bool good = value->is_array() && value->size() <= kMaxArrayLength;
  for (std::size_t i = 0; good && i < value->size(); ++i) {
    good = (*value)[i].is_string();
    if (good) texts.push_back((*value)[i].get<std::string>());
  }
  if (!good) return node_->complain_type(key, "a list of texts", *value);
  out = std::move(texts);
}

void ConfigReader::read_ms(std::string_view key, Duration& out, Duration least, Duration most) {
  double number = seconds(out) * kMillisecondsPerSecond;
  const double before = number;
  read(key, number, seconds(least) * kMillisecondsPerSecond,
       seconds(most) * kMillisecondsPerSecond);
  if (number != before) out = from_seconds(number / kMillisecondsPerSecond);
}

void ConfigReader::read_s(std::string_view key, Duration& out, Duration least, Duration most) {
  double number = seconds(out);
  const double before = number;
  read(key, number, seconds(least), seconds(most));
  if (number != before) out = from_seconds(number);
}

void ConfigReader::read_deg(std::string_view key, double& out, double least_deg, double most_deg) {
  double number = to_deg(out);
  const double before = number;
  read(key, number, least_deg, most_deg);
  if (number != before) out = deg(number);
}

void ConfigReader::read_choice(std::string_view key, std::size_t& index,
                               const std::vector<std::string_view>& names) {
  const json* value = node_->find(key);
  if (value == nullptr) return;
  std::string wanted;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (value->is_string() && value->get_ref<const std::string&>() == names[i]) {
      index = i;
      return;
    }
    wanted.append(i == 0 ? "" : ", ").append(names[i]);
  }
  node_->complain_type(key, "one of " + wanted, *value);
}

ConfigReader ConfigReader::child(std::string_view key) {
  static const json kEmpty = json::object();
  const json* value = node_->find(key);
  if (value != nullptr && !value->is_object()) {
    node_->complain_type(key, "an object { ... }", *value);
    value = nullptr;
  }
  return ConfigReader(node_->nested(std::string(key), value == nullptr ? kEmpty : *value));
}

std::vector<ConfigReader> ConfigReader::items(std::string_view key) {
  const json* value = node_->find(key);
  std::vector<ConfigReader> readers;
  if (value == nullptr) return readers;
  if (!value->is_array() || value->size() > kMaxArrayLength) {
    node_->complain_type(key, "a list of objects", *value);
    return readers;
  }
  for (std::size_t i = 0; i < value->size(); ++i) {
    const std::string name = joined(std::string(key), std::to_string(i));
    if ((*value)[i].is_object()) {
      readers.push_back(ConfigReader(node_->nested(name, (*value)[i])));
    } else {
      node_->complain_type(name, "an object { ... }", (*value)[i]);
    }
  }
  return readers;
}

bool ConfigReader::has(std::string_view key) const {
  return node_->value.contains(std::string(key));
}

std::string ConfigReader::text(std::string_view key) const {
  const auto found = node_->value.find(std::string(key));
  return found == node_->value.end() ? "" : dumped(*found);
}

std::string ConfigReader::text() const { return dumped(node_->value); }

void ConfigReader::complain(std::string_view key, std::string message) {
  node_->complain(key, message);
}

Result<void> ConfigReader::finish() const {
  std::vector<std::string> problems = *node_->problems;
  node_->list_unknown(problems);
  if (problems.empty()) return {};
  std::string message;
  for (const std::string& problem : problems) message += (message.empty() ? "" : "\n  ") + problem;
  return fail(ErrorCode::InvalidArgument, node_->origin, std::move(message));
}

}  // namespace chorus
