#include "common/ergonomics/task.h"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/nearest.h"
#include "common/ergonomics/all_methods.h"

namespace chorus::ergonomics {
namespace {

using nlohmann::json;

Error bad(const std::string& where, std::string message) {
  return {ErrorCode::InvalidArgument, where, std::move(message)};
}

constexpr std::array<std::string_view, 9> kAskedKeys{
    "loadKg",       "shock",          "coupling", "wrist",   "wristTwisted",
    "armSupported", "heldOverMinute", "repeated", "unstable"};

/// Every key must be an asked one or one of `own`.
Result<void> known_keys(const json& object, std::span<const std::string_view> own, bool asked,
                        const std::string& where) {
  if (!object.is_object()) return tl::unexpected<Error>(bad(where, "must be an object"));
  std::vector<std::string> known(own.begin(), own.end());
  if (asked) known.insert(known.end(), kAskedKeys.begin(), kAskedKeys.end());
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    const std::string near = nearest(key, known);
    return tl::unexpected<Error>(bad(
        fmt::format("{}.{}", where, key),
        near.empty() ? "is no key here" : fmt::format("is no key here; did you mean {}?", near)));
  }
  return {};
}

Result<double> number(const json& object, const char* key, double least, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number() || !(found->get<double>() >= least))
    return tl::unexpected<Error>(bad(fmt::format("{}.{}", where, key),
                                     fmt::format("must be a number of at least {:g}", least)));
  return found->get<double>();
}

Result<Span> span_in(const json& object, const std::string& where) {
  const auto from = number(object, "fromSeconds", 0.0, where);
  if (!from) return pass(from);
  const auto to = number(object, "toSeconds", 0.0, where);
  if (!to) return pass(to);
  if (!(*from < *to))
    return tl::unexpected<Error>(
        bad(where, fmt::format("ends at {:g} s, before it begins at {:g} s", *to, *from)));
  return Span{*from, *to};
}

Result<std::string> mark_named(const json& object, const char* key, const Marks& marks,
                               const std::string& where) {
  const auto found = object.find(key);
  const std::string at = fmt::format("{}.{}", where, key);
  if (found == object.end() || !found->is_string())
    return tl::unexpected<Error>(bad(at, "must be the name of a mark"));
  auto name = found->get<std::string>();
  if (std::ranges::find(marks.all, name, &NamedInstant::name) != marks.all.end()) return name;
  std::string known;
  for (const NamedInstant& mark : marks.all)
    if (known.find("'" + mark.name + "'") == std::string::npos)
      known += (known.empty() ? "'" : ", '") + mark.name + "'";
  return tl::unexpected<Error>(
      bad(at, fmt::format("the recording has no mark '{}'; {}", name,
                          known.empty() ? "it has none" : "it has " + known)));
}

/// From each mark of the one name to the next one of the other, or to the next of any name.
Result<std::vector<Span>> marked_spans(const json& object, const Marks& marks,
                                       const std::string& where) {
  if (object.contains("fromSeconds") || object.contains("toSeconds"))
    return tl::unexpected<Error>(bad(where, "is told by seconds or by marks, not by both"));
  const auto from = mark_named(object, "fromMark", marks, where);
  if (!from) return pass(from);
  const bool named_end = object.contains("toMark");
  const auto to = named_end ? mark_named(object, "toMark", marks, where) : Result<std::string>("");
  if (!to) return pass(to);
  std::vector<Span> spans;
  for (auto begin = marks.all.begin(); begin != marks.all.end(); ++begin) {
    if (begin->name != *from || (!spans.empty() && begin->at < spans.back().to)) continue;
    const auto end = std::find_if(begin + 1, marks.all.end(), [&](const NamedInstant& mark) {
      return mark.at > begin->at && (!named_end || mark.name == *to);
    });
    const double until = end == marks.all.end() ? marks.end : std::min(end->at, marks.end);
    if (begin->at >= 0.0 && begin->at < until) spans.push_back({begin->at, until});
  }
  if (spans.empty())
    return tl::unexpected<Error>(bad(where, "lies outside the frames of the recording"));
  return spans;
}

/// One span told by seconds, or one for each mark.
Result<std::vector<Span>> spans_in(const json& object, const Marks& marks,
                                   const std::string& where) {
  if (object.contains("fromMark") || object.contains("toMark"))
    return marked_spans(object, marks, where);
  const auto span = span_in(object, where);
  if (!span) return pass(span);
  return std::vector{*span};
}

Result<std::vector<Phase>> phases_in(const json& object, const Marks& marks,
                                     const std::string& where) {
  constexpr std::array<std::string_view, 5> kKeys{"name", "fromSeconds", "toSeconds", "fromMark",
                                                  "toMark"};
  if (auto ok = known_keys(object, kKeys, true, where); !ok) return pass(ok);
  const auto spans = spans_in(object, marks, where);
  if (!spans) return pass(spans);
  auto asked = read_asked(object, where);
  if (!asked) return pass(asked);
  const auto name = object.value("name", object.value("fromMark", json("")));
  if (!name.is_string()) return tl::unexpected<Error>(bad(where + ".name", "must be a text"));
  std::vector<Phase> phases;
  for (const Span& span : *spans) phases.push_back({name.get<std::string>(), span, *asked});
  return phases;
}

Result<void> read_phases(const json& list, const Marks& marks, Task& task,
                         const std::string& where) {
  if (!list.is_array()) return tl::unexpected<Error>(bad(where, "must be a list"));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto phases = phases_in(list[i], marks, fmt::format("{}[{}]", where, i));
    if (!phases) return pass(phases);
    task.phases.insert(task.phases.end(), phases->begin(), phases->end());
  }
  std::ranges::stable_sort(task.phases, {}, [](const Phase& phase) { return phase.span.from; });
  for (std::size_t i = 1; i < task.phases.size(); ++i) {
    const Phase& a = task.phases[i - 1];
    const Phase& b = task.phases[i];
    if (a.span.to > b.span.from)
      return tl::unexpected<Error>(
          bad(where, fmt::format("'{}' ({:g} to {:g} s) and '{}' ({:g} to {:g} s) overlap; each "
                                 "instant belongs to one phase at most",
                                 a.name, a.span.from, a.span.to, b.name, b.span.from, b.span.to)));
  }
  return {};
}

Result<TaskLift> lift_in(const json& object, const std::string& where) {
  const auto asked = read_asked(object, where);
  if (!asked) return pass(asked);
  if (!asked->load_kg || !asked->coupling || asked->coupling == Coupling::Unacceptable)
    return tl::unexpected<Error>(
        bad(where, "needs loadKg, and a coupling that is good, fair or poor"));
  const auto often = number(object, "perMinute", 0.0, where);
  if (!often) return pass(often);
  const auto hours = number(object, "hours", 0.0, where);
  if (!hours) return pass(hours);
  return TaskLift{{}, *asked->load_kg, *often, *hours, *asked->coupling};
}

Result<void> read_lifts(const json& list, const Marks& marks, Task& task, const std::string& file) {
  constexpr std::array<std::string_view, 8> kKeys{
      "fromSeconds", "toSeconds", "fromMark", "toMark", "loadKg", "perMinute", "hours", "coupling"};
  if (!list.is_array()) return tl::unexpected<Error>(bad(file, "must be a list"));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string where = fmt::format("{}[{}]", file, i);
    if (auto ok = known_keys(list[i], kKeys, false, where); !ok) return pass(ok);
    const auto spans = spans_in(list[i], marks, where);
    if (!spans) return pass(spans);
    auto lift = lift_in(list[i], where);
    if (!lift) return pass(lift);
    for (const Span& span : *spans) {
      lift->span = span;
      task.lifts.push_back(*lift);
    }
  }
  return {};
}

bool numbers(const json& list) {
  return list.is_array() && !list.empty() &&
         std::ranges::all_of(list, [](const json& each) { return each.is_number(); });
}

Result<ClassPoints> points_in(const json& object, const std::string& where) {
  const auto refuse = [&](std::string message) {
    return tl::unexpected<Error>(bad(where, std::move(message)));
  };
  if (!object.is_object() || !numbers(object.value("secondsPerMinute", json())) ||
      !object.value("points", json()).is_object())
    return refuse("needs secondsPerMinute, a list of numbers, and points, a list for each class");
  ClassPoints points;
  points.seconds_per_minute = object["secondsPerMinute"].get<std::vector<double>>();
  if (!std::ranges::is_sorted(points.seconds_per_minute))
    return refuse("secondsPerMinute must rise");
  for (const auto& [name, row] : object["points"].items()) {
    const auto known = std::ranges::find(kEaws.levels, name, &Level::key);
    if (known == kEaws.levels.end()) return refuse(fmt::format("'{}' is no class", name));
    if (!numbers(row) || row.size() != points.seconds_per_minute.size())
      return refuse(fmt::format("'{}' needs as many points as there are durations", name));
    points.points[name] = row.get<std::vector<double>>();
  }
  return points;
}

Result<void> read_parts(const json& object, const Marks& marks, Task& task,
                        const std::string& file) {
  if (object.contains("cycleSeconds")) {
    const auto cycle = number(object, "cycleSeconds", 1.0, file);
    if (!cycle) return pass(cycle);
    task.cycle = *cycle;
  }
  if (object.contains("stance")) {
    const auto spans = spans_in(object["stance"], marks, file + ".stance");
    if (!spans) return pass(spans);
    task.stance = spans->front();
  }
  if (object.contains("phases")) {
    if (auto ok = read_phases(object["phases"], marks, task, file + ".phases"); !ok) return ok;
  }
  if (object.contains("lifts")) {
    if (auto ok = read_lifts(object["lifts"], marks, task, file + ".lifts"); !ok) return ok;
  }
  if (!object.contains("eawsPoints")) return {};
  auto points = points_in(object["eawsPoints"], file + ".eawsPoints");
  if (!points) return pass(points);
  task.points = std::move(*points);
  return {};
}

Result<void> within(const Span& span, double seconds, const std::string& where) {
  // Half a frame at 30 Hz: who writes the recording's length means its end.
  constexpr double kRounding = 1.0 / 60.0;
  if (span.to <= seconds + kRounding) return {};
  return fail(ErrorCode::InvalidArgument, where,
              fmt::format("ends at {:g} s, but the recording lasts {:.2f} s", span.to, seconds));
}

}  // namespace

Asked Task::asked_at(double at) const {
  const auto phase = phase_at(at);
  return phase ? merged(asked, phases[*phase].asked) : asked;
}

std::optional<std::size_t> Task::phase_at(double at) const {
  for (std::size_t i = 0; i < phases.size(); ++i) {
    if (phases[i].span.holds(at)) return i;
  }
  return std::nullopt;
}

Result<Task> read_task(std::string_view text, const std::string& file, const Marks& marks) {
  JsonLimits limits;
  limits.comments = true;
  const auto object = parse_json(text, limits);
  if (!object)
    return tl::unexpected<Error>(Error{object.error().code, file, to_string(object.error())});
  constexpr std::array<std::string_view, 6> kKeys{"title",  "cycleSeconds", "stance",
                                                  "phases", "lifts",        "eawsPoints"};
  if (auto ok = known_keys(*object, kKeys, true, file); !ok) return pass(ok);
  Task task;
  auto asked = read_asked(*object, file);
  if (!asked) return pass(asked);
  task.asked = *asked;
  const auto title = object->value("title", json(""));
  if (!title.is_string()) return tl::unexpected<Error>(bad(file + ".title", "must be a text"));
  task.title = title.get<std::string>();
  if (auto ok = read_parts(*object, marks, task, file); !ok) return pass(ok);
  return task;
}

Result<void> fits(const Task& task, double seconds, const std::string& file) {
  if (task.stance) {
    if (auto ok = within(*task.stance, seconds, file + ".stance"); !ok) return ok;
  }
  for (const Phase& phase : task.phases) {
    if (auto ok = within(phase.span, seconds, fmt::format("{}: phase '{}'", file, phase.name)); !ok)
      return ok;
  }
  for (const TaskLift& lift : task.lifts) {
    if (auto ok = within(lift.span, seconds, file + ".lifts"); !ok) return ok;
  }
  return {};
}

}  // namespace chorus::ergonomics
