#include "common/ergonomics/method.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/nearest.h"
#include "common/ergonomics/all_methods.h"

namespace chorus::ergonomics {
namespace {

constexpr std::array<const Method*, 6> kMethods{&kReba,     &kRula,   &kOwas,
                                                &kIso11226, &kEn1005, &kEaws};

Codes filled(const Method& method, const Codes& codes, bool highest) {
  Codes full = codes;
  for (std::size_t i = 0; i < method.inputs.size(); ++i) {
    const Input& input = method.inputs[i];
    if (full[i] == 0) full[i] = static_cast<std::int8_t>(highest ? input.highest : input.lowest);
  }
  return full;
}

std::string range_words(const ScoreRange& range, bool german) {
  if (range.low == range.high) return std::to_string(range.low);
  return fmt::format("{} {} {}", range.low, german ? "bis" : "to", range.high);
}

}  // namespace

std::span<const Method* const> methods() { return kMethods; }

Result<const Method*> find_method(std::string_view name) {
  std::vector<std::string> names;
  for (const Method* method : kMethods) {
    if (method->name == name) return method;
    names.emplace_back(method->name);
  }
  const std::string near = nearest(name, names);
  return fail(ErrorCode::NotFound, std::string(name),
              fmt::format("is no method{}; there are {}",
                          near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                          fmt::join(names, ", ")));
}

Result<std::vector<const Method*>> find_methods(std::string_view list) {
  std::vector<const Method*> found;
  while (true) {
    const auto comma = list.find(',');
    const auto method = find_method(list.substr(0, comma));
    if (!method) return pass(method);
    if (std::ranges::find(found, *method) != found.end())
      return fail(ErrorCode::InvalidArgument, std::string((*method)->name), "is named twice");
    found.push_back(*method);
    if (comma == std::string_view::npos) return found;
    list.remove_prefix(comma + 1);
  }
}

std::size_t level_of(const Method& method, int score) {
  std::size_t level = 0;
  while (level + 1 < method.levels.size() && method.levels[level + 1].from <= score) ++level;
  return level;
}

Codes codes_of(const Method& method, const Seen& seen, Side side, const Asked& asked) {
  Codes codes{};
  method.measure(seen, side, codes);
  // Answers alone are no posture.
  if (codes != Codes{}) method.ask(asked, codes);
  return codes;
}

ScoreRange score_of(const Method& method, const Codes& codes) {
  if (codes == Codes{}) return {};
  bool unknown = false;
  for (std::size_t i = 0; i < method.inputs.size(); ++i) unknown |= codes[i] == 0;
  const int low = method.score(filled(method, codes, false));
  return {low, unknown ? method.score(filled(method, codes, true)) : low};
}

ScoreRange worse(const ScoreRange& a, const ScoreRange& b) {
  return {std::max(a.low, b.low), std::max(a.high, b.high)};
}

std::string range_text(const Method& method, const Codes& codes, bool german) {
  const ScoreRange range = score_of(method, codes);
  const std::string_view title = german ? method.title.de : method.title.en;
  if (!range.known()) return fmt::format("{}: {}", title, german ? "nicht gesehen" : "not seen");
  std::string text = fmt::format("{} {}", title, range_words(range, german));
  for (std::size_t i = 0; i < method.inputs.size(); ++i) {
    const Input& input = method.inputs[i];
    if (codes[i] != 0 || input.lowest_if.en.empty()) continue;
    Codes known = codes;
    known[i] = static_cast<std::int8_t>(input.lowest);
    const ScoreRange narrower = score_of(method, known);
    if (narrower == range) continue;
    text += fmt::format("; {} {} {}", range_words(narrower, german), german ? "falls" : "if",
                        german ? input.lowest_if.de : input.lowest_if.en);
  }
  return text;
}

}  // namespace chorus::ergonomics
