// Scores and methods as documents of linked data.
#pragma once

#include "common/resource/node.h"
#include "services/ergonomics/scoring.h"

namespace chorus::ergonomics_service {

using Methods = std::vector<const ergonomics::Method*>;

/// `/ergonomics/`: everybody's scores at the instant.
[[nodiscard]] resource::Node scores_node(const ScoreFrame& frame, const Methods& methods);

/// `/ergonomics/{person}`.
[[nodiscard]] resource::Node person_node(const PersonScores& person, const Methods& methods,
                                         std::string id);

/// `/methods/`: the methods with their inputs and levels.
[[nodiscard]] resource::Node methods_node(const Methods& methods);

}  // namespace chorus::ergonomics_service
