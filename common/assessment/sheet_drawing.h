// The drawings of a sheet, as SVG.
#pragma once

#include <string>

#include "common/body/skeleton.h"
#include "common/ergonomics/summary.h"

namespace chorus::assessment {

/// A stick figure from in front (as the person stands) or from its left; the left limbs are darker.
enum class View { Front, Left };
[[nodiscard]] std::string stick_figure(const Skeleton<WorldSpace>& body, View view);

/// The score of one method over time: a band for its 90 % set, a line for the score, grey where
/// there is none, and marks at the worst moments.  `label` names it for those who cannot see it.
[[nodiscard]] std::string score_timeline(const ergonomics::ScoredPerson& person, std::size_t method,
                                         const std::string& label);

}  // namespace chorus::assessment
