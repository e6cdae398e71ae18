#include "common/assessment/score_documents.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/units.h"

namespace chorus::assessment {
namespace {

using ergonomics::DoubtfulScore;
using ergonomics::Method;
using ergonomics::MethodSummary;
using nlohmann::json;

constexpr double kNinety = 0.9;

double rounded(double value, double step = 1e-3) { return std::round(value / step) * step; }

double at_seconds(const Assessment& about, Timestamp at) {
  return rounded(std::chrono::duration<double>(at - about.start).count());
}

json odds_json(const ergonomics::Odds& odds) {
  json out = json::object();
  for (std::size_t score = 1; score < odds.size(); ++score) {
    if (odds[score] > 0.0) out[std::to_string(score)] = rounded(odds[score]);
  }
  return out;
}

json zones_json(const MethodSummary& summary) {
  json zones = json::array();
  for (std::size_t l = 0; l < summary.levels.size(); ++l) {
    const auto& zone = summary.levels[l];
    zones.push_back({{"level", summary.method->levels[l].key},
                     {"share", rounded(zone.share)},
                     {"shareAsked", {rounded(zone.least), rounded(zone.most)}},
                     {"share90", {rounded(zone.low), rounded(zone.high)}},
                     {"secondsPerMinute", rounded(60.0 * zone.share, 0.01)}});
  }
  return zones;
}

json worst_json(const MethodSummary& summary) {
  json worst = json::array();
  for (const auto& moment : summary.worst)
    worst.push_back({{"atSeconds", rounded(moment.at)},
                     {"score", {moment.score.low, moment.score.high}},
                     {"set90", {moment.set.from, moment.set.to}}});
  return worst;
}

json summary_of_method(const MethodSummary& summary) {
  json unscored = json::object();
  for (std::size_t r = 1; r < ergonomics::kReasons; ++r) {
    if (summary.unscored[r] > 0.0)
      unscored[std::string(name_of(static_cast<ergonomics::Unscored>(r)))] =
          rounded(summary.unscored[r]);
  }
  json out{{"scoredShare", rounded(summary.scored)},
           {"unscored", unscored},
           {"levels", zones_json(summary)}};
  if (!summary.method->ordered || summary.p50 == 0) return out;
  out["p50"] = summary.p50;
  out["p90"] = summary.p90;
  out["worst"] = worst_json(summary);
  out["certainShare"] = rounded(summary.certain);
  if (summary.method->sided)
    out["p90OfSides"] = {{"left", summary.side_p90[0]}, {"right", summary.side_p90[1]}};
  return out;
}

/// Points of the user's own sheet for a class; none where it is shorter than the first column.
double points_of(const ergonomics::ClassPoints& table, const std::string& name, double seconds) {
  const auto row = table.points.find(name);
  if (row == table.points.end()) return 0.0;
  double points = 0.0;
  for (std::size_t i = 0; i < table.seconds_per_minute.size(); ++i) {
    if (seconds >= table.seconds_per_minute[i]) points = row->second[i];
  }
  return points;
}

json methods_of(const std::vector<MethodSummary>& summaries, const ergonomics::Task& task) {
  json out = json::object();
  for (const MethodSummary& summary : summaries) {
    json each = summary_of_method(summary);
    if (!summary.method->ordered && task.points) {
      double sum = 0.0;
      for (std::size_t l = 0; l < summary.levels.size(); ++l)
        sum += points_of(*task.points, std::string(summary.method->levels[l].key),
                         60.0 * summary.levels[l].share);
      each["points"] = sum;
    }
    out[std::string(summary.method->name)] = std::move(each);
  }
  return out;
}

json lift_json(const MeasuredLift& lift) {
  const auto end = [](const ergonomics::Lift& at, const ergonomics::LiftLimit& limit) {
    return json{{"horizontalCm", rounded(100 * at.horizontal, 0.1)},
                {"verticalCm", rounded(100 * at.vertical, 0.1)},
                {"asymmetryDeg", rounded(to_deg(at.asymmetry), 0.1)},
                {"multipliers",
                 {{"HM", rounded(limit.hm)},
                  {"VM", rounded(limit.vm)},
                  {"DM", rounded(limit.dm)},
                  {"AM", rounded(limit.am)},
                  {"FM", rounded(limit.fm)},
                  {"CM", rounded(limit.cm)}}},
                {"limitKg", rounded(limit.weight_kg, 0.01)}};
  };
  return {{"fromSeconds", lift.asked.span.from},
          {"toSeconds", lift.asked.span.to},
          {"loadKg", lift.asked.load_kg},
          {"origin", end(lift.origin, lift.origin_limit)},
          {"destination", end(lift.destination, lift.destination_limit)},
          {"liftingIndex", std::isfinite(lift.index) ? json(rounded(lift.index, 0.01)) : json()}};
}

json person_json(const AssessedPerson& person, const Assessment& about) {
  const auto& scored = person.scored;
  json out{{"person", person.id},
           {"seconds", rounded(scored.seconds)},
           {"ownStance", scored.has_stance},
           {"jointsWithoutDoubt", scored.doubtless},
           {"methods", methods_of(scored.methods, about.task)}};
  if (scored.cycles) out["cycles"] = rounded(*scored.cycles, 0.01);
  out["phases"] = json::array();
  for (std::size_t p = 0; p < scored.phases.size(); ++p)
    out["phases"].push_back({{"name", about.task.phases[p].name},
                             {"fromSeconds", about.task.phases[p].span.from},
                             {"toSeconds", about.task.phases[p].span.to},
                             {"methods", methods_of(scored.phases[p], about.task)}});
  out["movementsPerMinute"] = json::array();
  for (const auto& count : scored.movements)
    out["movementsPerMinute"].push_back({{"measure", count.measure},
                                         {"beyondDeg", rounded(to_deg(count.limit), 0.1)},
                                         {"perMinute", rounded(count.per_minute, 0.01)}});
  out["lifts"] = json::array();
  for (const MeasuredLift& lift : person.lifts) out["lifts"].push_back(lift_json(lift));
  if (person.lifts_unseen > 0) out["liftsNotSeen"] = person.lifts_unseen;
  if (person.workplace) out["workplace"] = workplace_json(*person.workplace);
  out["events"] = json::array();
  for (const auto& event : person.events)
    out["events"].push_back({{"posture", event.name},
                             {"fromSeconds", at_seconds(about, event.from)},
                             {"toSeconds", at_seconds(about, event.until)},
                             {"probability", rounded(event.probability)}});
  return out;
}

std::string score_line(const AssessedPerson& person, const Method& method, std::size_t i,
                       std::size_t m) {
  const auto& instant = person.scored.instants[i];
  const DoubtfulScore& score = instant.scores[m];
  const std::string head = fmt::format("{:.3f},{},{},", instant.at, person.id, method.name);
  if (!score.known()) {
    const auto reason = person.scored.observations[i].reason;
    return head + fmt::format(",,,,,,,,{}\n", reason == ergonomics::Unscored::None
                                                  ? name_of(ergonomics::Unscored::NotSeen)
                                                  : name_of(reason));
  }
  const auto set = set_of(score, kNinety);
  const auto side = [&](std::size_t s) {
    return method.sided && score.sides[s].known() ? std::to_string(score.sides[s].high)
                                                  : std::string();
  };
  return head + fmt::format("{},{},{},{},{:.2f},{},{},{},\n", score.score.low, score.score.high,
                            set.from, set.to, set.probability,
                            method.levels[level_of(method, score.score.high)].key, side(0),
                            side(1));
}

}  // namespace

AssessedPerson assess(const PersonInput& person, const Assessment& about,
                      const std::vector<ergonomics::PostureRule>& rules) {
  AssessedPerson out;
  out.id = person.id;
  out.scored = ergonomics::score_person(
      {person.bodies, about.methods, about.task, about.start, person.stance});
  for (const auto& lift : about.task.lifts) {
    if (const auto measured = measured_lift(person.bodies, lift, about.start))
      out.lifts.push_back(*measured);
    else
      ++out.lifts_unseen;
  }
  if (about.scene)
    out.workplace = at_workplace({person.id, person.bodies, about.start}, *about.scene);
  ergonomics::PostureWatch watch(rules);
  const auto keep = [&](std::vector<ergonomics::PostureEvent> events) {
    out.events.insert(out.events.end(), events.begin(), events.end());
  };
  for (const auto& observation : out.scored.observations) keep(watch.add(observation));
  keep(watch.finish());
  std::ranges::stable_sort(out.events, {}, &ergonomics::PostureEvent::from);
  return out;
}

json score_json(const Method& method, const DoubtfulScore& score) {
  if (!score.known()) return json();
  const auto set = set_of(score, kNinety);
  const auto& level = method.levels[level_of(method, score.score.high)];
  json out{{"low", score.score.low},        {"high", score.score.high},
           {"set90", {set.from, set.to}},   {"probability", rounded(set.probability)},
           {"odds", odds_json(score.high)}, {"level", level.key},
           {"text", level.text.en}};
  if (method.sided)
    out["sides"] = {{"left", {score.sides[0].low, score.sides[0].high}},
                    {"right", {score.sides[1].low, score.sides[1].high}}};
  return out;
}

json method_json(const Method& method) {
  json inputs = json::array();
  for (const auto& input : method.inputs)
    inputs.push_back(
        {{"key", input.key},
         {"name", input.name.en},
         {"origin", input.origin == ergonomics::Origin::Measured ? "measured" : "asked"},
         {"codes", {input.lowest, input.highest}}});
  json levels = json::array();
  for (const auto& level : method.levels)
    levels.push_back({{"from", level.from}, {"key", level.key}, {"text", level.text.en}});
  return {{"name", method.name},     {"title", method.title.en}, {"source", method.source},
          {"inputs", inputs},        {"levels", levels},         {"highest", method.highest},
          {"ofSides", method.sided}, {"ordered", method.ordered}};
}

std::string summary_json(const Assessment& assessment) {
  json methods = json::array();
  for (const Method* method : assessment.methods) methods.push_back(method_json(*method));
  json persons = json::array();
  for (const AssessedPerson& person : assessment.persons)
    persons.push_back(person_json(person, assessment));
  return json{{"source", assessment.source},
              {"title", assessment.task.title},
              {"start", to_iso8601(assessment.start)},
              {"seconds", rounded(assessment.seconds)},
              {"screening", "a screening, not a certified assessment"},
              {"methods", methods},
              {"persons", persons},
              {"notes", assessment.notes}}
             .dump(1) +
         "\n";
}

std::string scores_csv(const Assessment& assessment) {
  std::string text =
      "time_s,person,method,low,high,set_from,set_to,probability,level,left,right,unscored\n";
  for (const AssessedPerson& person : assessment.persons) {
    for (std::size_t i = 0; i < person.scored.instants.size(); ++i) {
      for (std::size_t m = 0; m < assessment.methods.size(); ++m)
        text += score_line(person, *assessment.methods[m], i, m);
    }
  }
  return text;
}

std::string measures_csv(const Assessment& assessment) {
  std::string text = "time_s,person";
  for (std::size_t m = 0; m < posture::kMeasures; ++m)
    text += fmt::format(",{}_{}", posture::name_of(m),
                        posture::row_of(m).unit == posture::Unit::Angle ? "deg" : "m");
  text += '\n';
  for (const AssessedPerson& person : assessment.persons) {
    for (const auto& seen : person.scored.observations) {
      text += fmt::format("{:.3f},{}", at_seconds(assessment, seen.at), person.id);
      for (std::size_t m = 0; m < posture::kMeasures; ++m) {
        const double value = seen.seen.measures.values[m];
        const bool angle = posture::row_of(m).unit == posture::Unit::Angle;
        text += std::isnan(value) ? "," : fmt::format(",{:.3f}", angle ? to_deg(value) : value);
      }
      text += '\n';
    }
  }
  return text;
}

std::string instant_json(const AssessedPerson& person, const Assessment& assessment,
                         std::size_t index) {
  json methods = json::object();
  for (std::size_t m = 0; m < assessment.methods.size(); ++m)
    methods[std::string(assessment.methods[m]->name)] =
        score_json(*assessment.methods[m], person.scored.instants[index].scores[m]);
  return json{{"person", person.id},
              {"captured", to_iso8601(person.scored.observations[index].at)},
              {"methods", methods}}
      .dump();
}

}  // namespace chorus::assessment
