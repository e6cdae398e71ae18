#include "common/http/router.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>

#include "common/http/route_table.h"

namespace chorus::http {
namespace {

struct MethodRow {
  Method method;
  std::string_view name;
};

constexpr std::array kMethods{
    MethodRow{Method::Get, "GET"},         MethodRow{Method::Head, "HEAD"},
    MethodRow{Method::Options, "OPTIONS"}, MethodRow{Method::Post, "POST"},
    MethodRow{Method::Put, "PUT"},         MethodRow{Method::Patch, "PATCH"},
    MethodRow{Method::Delete, "DELETE"},
};

template <class Text>
std::vector<Text> split(std::string_view path) {
  std::vector<Text> segments;
  while (true) {
    const std::size_t slash = path.find('/');
    segments.emplace_back(path.substr(0, slash));
    if (slash == std::string_view::npos) return segments;
    path.remove_prefix(slash + 1);
  }
}

bool is_parameter(std::string_view segment) {
  return segment.size() > 2 && segment.front() == '{' && segment.back() == '}';
}

bool fits(const Router::Entry& entry, std::span<const std::string_view> segments) {
  if (entry.files || entry.segments.size() != segments.size()) return false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const bool parameter = is_parameter(entry.segments[i]) && !segments[i].empty();
    if (!parameter && entry.segments[i] != segments[i]) return false;
  }
  return true;
}

/// True when `a` has the literal at the first segment where only one of the two patterns has one.
bool more_literal(const Router::Entry& a, const Router::Entry& b) {
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    const bool literal_a = !is_parameter(a.segments[i]);
    if (literal_a == is_parameter(b.segments[i])) return literal_a;
  }
  return false;
}

PathParams params_of(const Router::Entry& entry, std::span<const std::string_view> segments) {
  PathParams params;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string_view name = entry.segments[i];
    if (is_parameter(name))
      params.emplace(name.substr(1, name.size() - 2), std::string(segments[i]));
  }
  return params;
}

}  // namespace

Router::Router() = default;
Router::~Router() = default;
Router::Router(Router&&) noexcept = default;
Router& Router::operator=(Router&&) noexcept = default;

const Router::Entry* Router::entry_like(std::string_view pattern) const {
  const auto wanted = split<std::string_view>(pattern);
  const auto alike = [&](const std::unique_ptr<Entry>& entry) {
    return std::ranges::equal(entry->segments, wanted, [](std::string_view a, std::string_view b) {
      return a == b || (is_parameter(a) && is_parameter(b));
    });
  };
  const auto found = std::ranges::find_if(entries_, alike);
  return found == entries_.end() ? nullptr : found->get();
}

Router::Entry& Router::entry_of(const std::string& pattern) {
  assert(!pattern.empty() && pattern.front() == '/');
  for (const auto& entry : entries_) {
    if (entry->pattern == pattern) return *entry;
  }
  auto& entry = *entries_.emplace_back(std::make_unique<Entry>());
  entry.pattern = pattern;
  entry.segments = split<std::string>(pattern);
  entry.index = entries_.size() - 1;
  if (pattern.find('{') == std::string::npos) literal_.emplace(pattern, &entry);
  return entry;
}

void Router::get(std::string pattern, Getter getter) {
  Entry& entry = entry_of(pattern);
  assert(!entry.readable());
  entry.getter = std::move(getter);
}

void Router::live(std::string pattern, std::shared_ptr<LiveDocument> document) {
  Entry& entry = entry_of(pattern);
  assert(!entry.readable() && document);
  entry.live = std::move(document);
}

void Router::logged(const std::string& pattern, std::shared_ptr<const LoggedEvents> log) {
  Entry& entry = entry_of(pattern);
  assert(entry.live && log);
  entry.log = std::move(log);
}

void Router::by_query(const std::string& pattern, std::string key, Getter getter) {
  Entry& entry = entry_of(pattern);
  assert(entry.live && !entry.by_query && !key.empty());
  entry.query_key = std::move(key);
  entry.by_query = std::move(getter);
}

void Router::action(Method method, std::string pattern, Action action) {
  assert(method != Method::Get && method != Method::Head && method != Method::Options);
  [[maybe_unused]] const bool added =
      entry_of(pattern).actions.emplace(method, std::move(action)).second;
  assert(added);
}

void Router::dialogue(const std::string& pattern, DialogueRoute route) {
  Entry& entry = entry_of(pattern);
  assert(!entry.live && !entry.dialogue && route.open);
  entry.dialogue = std::move(route);
}

void Router::files(std::string prefix, std::string folder, const FilesAre& about) {
  assert(prefix.back() == '/');
  Entry& entry = entry_of(prefix);
  assert(!entry.readable());
  entry.files = std::make_unique<StaticFiles>(std::move(folder), about);
}

void Router::vital(const std::string& pattern) { entry_of(pattern).vital = true; }

void Router::for_everybody(const std::string& pattern) { entry_of(pattern).for_everybody = true; }

void Router::shows_people(const std::string& pattern) { entry_of(pattern).shows_people = true; }

Result<Router::Match> Router::match(std::string_view path) const {
  if (const auto literal = literal_.find(path); literal != literal_.end())
    return Match{literal->second};
  const auto segments = split<std::string_view>(path);
  const Entry* best = nullptr;
  for (const auto& entry : entries_) {
    if (fits(*entry, segments) && (best == nullptr || more_literal(*entry, *best)))
      best = entry.get();
  }
  if (best != nullptr) return Match{best, params_of(*best, segments)};
  for (const auto& entry : entries_) {
    if (!entry->files || !path.starts_with(entry->pattern)) continue;
    if (best == nullptr || entry->pattern.size() > best->pattern.size()) best = entry.get();
  }
  if (best != nullptr) return Match{best, {}, path.substr(best->pattern.size())};
  return fail(ErrorCode::NotFound, std::string(path),
              "there is no such resource; \"/\" links to what there is");
}

std::string allowed_methods(const Router::Entry& entry) {
  std::string list = entry.readable() ? "GET, HEAD, OPTIONS" : "OPTIONS";
  for (const auto& [method, action] : entry.actions) list.append(", ").append(name_of(method));
  return list;
}

std::string_view name_of(Method method) noexcept {
  for (const MethodRow& row : kMethods) {
    if (row.method == method) return row.name;
  }
  return "GET";
}

}  // namespace chorus::http
