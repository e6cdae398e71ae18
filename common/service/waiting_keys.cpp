#include "common/service/waiting_keys.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace chorus::service {
namespace {

using nlohmann::json;
using Path = std::vector<std::string>;

json parsed(std::string_view text) {
  constexpr bool kExceptions = false;
  return json::parse(text, nullptr, kExceptions);
}

/// The value of the key; null when the object has no such key.
const json* value_at(const json& object, const std::string& key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

/// Appends the paths at which a and b differ.  If one value is an object and the other is missing,
/// the missing one counts as an empty object.
void add_changes(const json& a, const json& b, Path& at, std::vector<Path>& out) {
  static const json kNothing = json::object();
  json names = a;
  names.update(b);
  for (const auto& [key, unused] : names.items()) {
    const json* left = value_at(a, key);
    const json* right = value_at(b, key);
    if (left == nullptr && right->is_object()) left = &kNothing;
    if (right == nullptr && left->is_object()) right = &kNothing;
    at.push_back(key);
    if (left != nullptr && right != nullptr && left->is_object() && right->is_object()) {
      add_changes(*left, *right, at, out);
    } else if (left == nullptr || right == nullptr || *left != *right) {
      out.push_back(at);
    }
    at.pop_back();
  }
}

/// Returns `base`, but with the value that `wanted` has at `path`; if `wanted` has none there, the
/// value is removed.
json with_one_change(json base, const Path& path, const json& wanted) {
  json* to = &base;
  const json* from = &wanted;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    to = &(*to)[path[i]];
    if (!to->is_object()) *to = json::object();
    from = from == nullptr ? nullptr : value_at(*from, path[i]);
  }
  const json* value = from == nullptr ? nullptr : value_at(*from, path.back());
  if (value == nullptr) {
    to->erase(path.back());
  } else {
    (*to)[path.back()] = *value;
  }
  return base;
}

std::string joined(const Path& path) {
  std::string text;
  for (const std::string& part : path) text += (text.empty() ? "" : ".") + part;
  return text;
}

}  // namespace

std::vector<std::string> changed_keys(std::string_view running, std::string_view wanted) {
  return waiting_keys(running, wanted, [](const std::string&) { return true; });
}

std::vector<std::string> waiting_keys(std::string_view running, std::string_view wanted,
                                      const NeedsRestart& needs_restart) {
  const json now = parsed(running);
  const json next = parsed(wanted);
  if (!now.is_object() || !next.is_object()) return {};
  Path at;
  std::vector<Path> changed;
  add_changes(now, next, at, changed);
  std::vector<std::string> keys;
  for (const Path& path : changed) {
    if (needs_restart(with_one_change(now, path, next).dump())) keys.push_back(joined(path));
  }
  return keys;
}

std::string with_keys_of(std::string_view text, std::string_view other,
                         const std::vector<std::string>& keys) {
  json out = parsed(text);
  const json from = parsed(other);
  if (!out.is_object() || !from.is_object()) return std::string(text);
  for (const std::string& key : keys) {
    Path path;
    for (std::size_t begin = 0; begin <= key.size();) {
      const std::size_t end = std::min(key.find('.', begin), key.size());
      path.push_back(key.substr(begin, end - begin));
      begin = end + 1;
    }
    out = with_one_change(std::move(out), path, from);
  }
  return out.dump();
}

}  // namespace chorus::service
