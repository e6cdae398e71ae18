#include "common/ergonomics/named_postures.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "common/base/nearest.h"
#include "common/base/units.h"
#include "printed_tables.h"

namespace chorus::ergonomics {
namespace {

constexpr std::array<std::pair<std::string_view, Legs>, 7> kLegNames{
    {{"sitting", Legs::Sitting},
     {"straight", Legs::Straight},
     {"one straight", Legs::OneStraight},
     {"bent", Legs::Bent},
     {"one bent", Legs::OneBent},
     {"kneeling", Legs::Kneeling},
     {"walking", Legs::Walking}}};

Result<std::size_t> measure_named(const std::string& name, Sides sides) {
  std::vector<std::string> known;
  if (sides == Sides::Centre) {
    for (std::size_t m = 0; m < posture::kMeasures; ++m) known.emplace_back(posture::name_of(m));
  } else {
    for (const auto& row : posture::limb_rows()) known.emplace_back(row.name);
  }
  const auto found = std::ranges::find(known, name);
  if (found == known.end())
    return fail(ErrorCode::Malformed, name,
                fmt::format("is no measure; did you mean {}?", nearest(name, known)));
  const auto index = static_cast<std::size_t>(found - known.begin());
  return sides == Sides::Centre ? index : posture::kCentres + index;
}

Result<Condition> legs_condition(std::istringstream& words) {
  std::string name;
  std::getline(words >> std::ws, name);
  for (const auto& [text, legs] : kLegNames) {
    if (text == name) {
      Condition condition;
      condition.legs = legs;
      return condition;
    }
  }
  return fail(ErrorCode::Malformed, "legs " + name, "is no way to stand");
}

Result<Condition> condition_of(const std::string& text) {
  std::istringstream words(text);
  std::string word;
  words >> word;
  if (word == "legs") return legs_condition(words);
  Condition condition;
  if (word == "either" || word == "both") {
    condition.sides = word == "both" ? Sides::Both : Sides::Either;
    words >> word;
  }
  if (word.size() > 2 && word.front() == '|' && word.back() == '|') {
    condition.absolute = true;
    word = word.substr(1, word.size() - 2);
  }
  const auto measure = measure_named(word, condition.sides);
  if (!measure) return pass(measure);
  condition.measure = *measure;
  std::string compares, unit, rest;
  const bool angle = posture::row_of(*measure).unit == posture::Unit::Angle;
  if (!(words >> compares >> condition.limit >> unit) || (compares != ">" && compares != "<") ||
      unit != (angle ? "deg" : "m") || words >> rest)
    return fail(ErrorCode::Malformed, word,
                fmt::format("needs > or <, a number and {}", angle ? "deg" : "m"));
  condition.above = compares == ">";
  if (angle) condition.limit = deg(condition.limit);
  return condition;
}

Result<PostureRule> rule_of(const std::string& line) {
  const auto colon = line.find(':');
  std::istringstream head(line.substr(0, colon));
  PostureRule rule;
  double seconds = 0.0;
  if (colon == std::string::npos || !(head >> rule.name >> seconds) || !(seconds >= 0.0))
    return fail(ErrorCode::Malformed, line, "must be NAME SECONDS: CONDITION, ...");
  rule.lasts = Duration(std::llround(seconds * 1e9));
  std::istringstream conditions(line.substr(colon + 1));
  std::string text;
  while (std::getline(conditions, text, ',')) {
    const auto condition = condition_of(text);
    if (!condition) return pass(condition);
    rule.conditions.push_back(*condition);
  }
  if (rule.conditions.empty()) return fail(ErrorCode::Malformed, rule.name, "has no condition");
  return rule;
}

bool holds(const Condition& condition, const Seen& seen, std::size_t measure) {
  const double value = seen.measures.values[measure];
  const double compared = condition.absolute ? std::abs(value) : value;
  return condition.above ? compared > condition.limit : compared < condition.limit;
}

bool holds(const Condition& condition, const Seen& seen) {
  if (condition.legs) return legs_of(seen) == condition.legs;
  const bool left = holds(condition, seen, condition.measure);
  if (condition.sides == Sides::Centre) return left;
  const bool right = holds(condition, seen, condition.measure + posture::kLimbs);
  return condition.sides == Sides::Both ? left && right : left || right;
}

double odds_of(const PostureRule& rule, const Observation& observation) {
  Seen seen = observation.seen;
  double sum = 0.0;
  for (const Measures& draw : observation.draws) {
    seen.measures = draw;
    sum += holds(rule, seen) ? 1.0 : 0.0;
  }
  return sum / static_cast<double>(observation.draws.size());
}

}  // namespace

Result<std::vector<PostureRule>> read_rules(std::string_view text, const std::string& file) {
  std::vector<PostureRule> rules;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    auto rule = rule_of(line);
    if (!rule)
      return fail(ErrorCode::Malformed, fmt::format("{}:{}", file, number),
                  to_string(rule.error()));
    rules.push_back(std::move(*rule));
  }
  return rules;
}

const std::vector<PostureRule>& shipped_rules() {
  static const std::vector<PostureRule> kRules =
      read_rules(printed::postures, "postures.txt").value_or(std::vector<PostureRule>{});
  return kRules;
}

bool holds(const PostureRule& rule, const Seen& seen) {
  return std::ranges::all_of(rule.conditions,
                             [&](const Condition& each) { return holds(each, seen); });
}

PostureWatch::PostureWatch(std::vector<PostureRule> rules)
    : rules_(std::move(rules)), running_(rules_.size()) {}

std::optional<PostureEvent> PostureWatch::event_of(std::size_t rule, bool open) const {
  const Running& running = running_[rule];
  if (!running.on || running.last - running.from < rules_[rule].lasts) return std::nullopt;
  return PostureEvent{rules_[rule].name, running.from, running.last, running.odds / running.count,
                      open};
}

std::vector<PostureEvent> PostureWatch::add(const Observation& observation) {
  std::vector<PostureEvent> ended;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    Running& running = running_[r];
    Seen steady = observation.seen;
    steady.measures = observation.shown;
    const bool on = observation.reason == Unscored::None && holds(rules_[r], steady);
    if (!on) {
      if (auto event = event_of(r, false)) ended.push_back(std::move(*event));
      running = {};
      continue;
    }
    if (!running.on) running = {true, observation.at, observation.at, 0.0, 0.0};
    running.last = observation.at;
    running.odds += odds_of(rules_[r], observation);
    running.count += 1.0;
  }
  return ended;
}

std::vector<PostureEvent> PostureWatch::current() const {
  std::vector<PostureEvent> events;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    if (auto event = event_of(r, true)) events.push_back(std::move(*event));
  }
  return events;
}

std::vector<PostureEvent> PostureWatch::finish() {
  auto events = current();
  running_.assign(rules_.size(), {});
  return events;
}

}  // namespace chorus::ergonomics
