#include "services/ergonomics/score_nodes.h"

#include <fmt/format.h>

namespace chorus::ergonomics_service {
namespace {

using resource::Decimal;
using resource::Node;
using resource::Value;

constexpr double kNinety = 0.9;
constexpr int kDigits = 3;

Node score_node(const ergonomics::Method& method, const ergonomics::DoubtfulScore& score,
                const ergonomics::ScoreRange& shown) {
  Node node{"_", {"PostureScore"}, {{"method", std::string(method.name)}}};
  if (!score.known()) return node;
  const auto set = set_of(score, kNinety);
  const auto& level = method.levels[level_of(method, score.score.high)];
  node.properties.insert(node.properties.end(),
                         {{"scoreLow", std::int64_t{score.score.low}},
                          {"scoreHigh", std::int64_t{score.score.high}},
                          {"setFrom", std::int64_t{set.from}},
                          {"setTo", std::int64_t{set.to}},
                          {"setProbability", Decimal{set.probability, kDigits}},
                          {"shownScore", std::int64_t{shown.high}},
                          {"scoreLevel", std::string(level.key)}});
  if (!method.sided) return node;
  node.properties.emplace_back("scoreLeft", std::int64_t{score.sides[0].high});
  node.properties.emplace_back("scoreRight", std::int64_t{score.sides[1].high});
  return node;
}

std::string stance_name(Stance stance) {
  return stance == Stance::Known ? "known" : stance == Stance::Asked ? "asked" : "missing";
}

Node posture_node(const ergonomics::PostureEvent& event) {
  return {"_",
          {"NamedPosture"},
          {{"postureName", event.name},
           {"since", event.from},
           {"postureProbability", Decimal{event.probability, kDigits}}}};
}

}  // namespace

Node person_node(const PersonScores& person, const Methods& methods, std::string id) {
  Node node{std::move(id),
            {"ScoredPerson"},
            {{"bodyId", static_cast<std::int64_t>(person.person)},
             {"captured", person.captured},
             {"ownStance", stance_name(person.stance)}}};
  if (!person.stance_trouble.empty())
    node.properties.emplace_back("stanceTrouble", person.stance_trouble);
  if (person.reason != ergonomics::Unscored::None)
    node.properties.emplace_back("unscored", std::string(name_of(person.reason)));
  std::vector<Node> scores;
  for (std::size_t m = 0; m < methods.size(); ++m)
    scores.push_back(score_node(*methods[m], person.scores[m], person.shown[m]));
  node.properties.emplace_back("scores", std::move(scores));
  std::vector<Node> postures;
  for (const auto& event : person.postures) postures.push_back(posture_node(event));
  node.properties.emplace_back("postures", std::move(postures));
  return node;
}

Node scores_node(const ScoreFrame& frame, const Methods& methods) {
  std::vector<Node> persons;
  std::vector<resource::Ref> members;
  for (const PersonScores& person : frame.persons) {
    persons.push_back(person_node(person, methods, std::to_string(person.person)));
    members.push_back({std::to_string(person.person)});
  }
  return {"",
          {"PostureScores", "ldp:BasicContainer"},
          {{"sequence", static_cast<std::int64_t>(frame.sequence)},
           {"captured", frame.captured},
           {"persons", std::move(persons)},
           {"contains", std::move(members)}}};
}

Node methods_node(const Methods& methods) {
  std::vector<Node> nodes;
  for (const ergonomics::Method* method : methods) {
    std::vector<Node> inputs;
    for (const auto& input : method->inputs)
      inputs.push_back(
          {"_",
           {"PostureInput"},
           {{"inputName", std::string(input.key)},
            {"inputOrigin",
             std::string(input.origin == ergonomics::Origin::Measured ? "measured" : "asked")},
            {"lowestCode", std::int64_t{input.lowest}},
            {"highestCode", std::int64_t{input.highest}}}});
    std::vector<Node> levels;
    for (const auto& level : method->levels)
      levels.push_back({"_",
                        {"PostureLevel"},
                        {{"fromScore", std::int64_t{level.from}},
                         {"scoreLevel", std::string(level.key)},
                         {"levelMeaning", std::string(level.text.en)}}});
    nodes.push_back({fmt::format("#{}", method->name),
                     {"PostureMethod"},
                     {{"method", std::string(method->name)},
                      {"title", std::string(method->title.en)},
                      {"methodSource", std::string(method->source)},
                      {"inputs", std::move(inputs)},
                      {"levels", std::move(levels)}}});
  }
  return {"", {"PostureMethods"}, {{"methods", std::move(nodes)}}};
}

}  // namespace chorus::ergonomics_service
