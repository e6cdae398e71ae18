// Scores as JSON and CSV.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/assessment/at_workplace.h"
#include "common/assessment/lifts.h"
#include "common/ergonomics/named_postures.h"
#include "common/ergonomics/summary.h"

namespace chorus::assessment {

/// One person of a recording, with everything that was found.
struct AssessedPerson {
  std::uint64_t id = 0;
  ergonomics::ScoredPerson scored;
  std::vector<MeasuredLift> lifts;
  std::size_t lifts_unseen = 0;
  std::vector<ergonomics::PostureEvent> events;
  std::optional<AtWorkplace> workplace = {};  ///< If there is a scene.
};

struct Assessment {
  std::string source;
  Timestamp start;
  double seconds = 0.0;
  std::vector<const ergonomics::Method*> methods;
  ergonomics::Task task;
  std::optional<workplace::Scene> scene = {};
  std::vector<AssessedPerson> persons;
  std::vector<std::string> notes;
};

/// Everything about one person of a recording.
struct PersonInput {
  std::uint64_t id = 0;
  const std::vector<ergonomics::BodyAt>& bodies;
  std::optional<posture::Neutral> stance = {};
};
[[nodiscard]] AssessedPerson assess(const PersonInput& person, const Assessment& about,
                                    const std::vector<ergonomics::PostureRule>& rules);

/// The score of one method at an instant, with `german` texts or not:
/// {"low", "high", "set": [from, to], "probability", "odds": {"4": 0.7}, "level", "text"}.
[[nodiscard]] nlohmann::json score_json(const ergonomics::Method& method,
                                        const ergonomics::DoubtfulScore& score);

/// Each method as a value: name, title, source, inputs with their origin, levels.
[[nodiscard]] nlohmann::json method_json(const ergonomics::Method& method);

/// The summary of a recording; angles in degrees, times in seconds from its beginning.
[[nodiscard]] std::string summary_json(const Assessment& assessment);

/// A line for each instant, person and method:
/// time_s,person,method,low,high,set_from,set_to,probability,level,left,right,unscored
[[nodiscard]] std::string scores_csv(const Assessment& assessment);

/// A line for each instant and person with all measures [deg, m] relative to the person's stance.
[[nodiscard]] std::string measures_csv(const Assessment& assessment);

/// The scores of all people at one instant, as a message of a recording.
[[nodiscard]] std::string instant_json(const AssessedPerson& person, const Assessment& assessment,
                                       std::size_t index);

}  // namespace chorus::assessment
