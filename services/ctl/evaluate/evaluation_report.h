// The report of `chorus evaluate`: the paper's Figures 5, 7, 8 and 9 of one take, and its numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/evaluation/judge.h"
#include "common/report/report.h"
#include "services/ctl/evaluate/reference_section.h"

namespace chorus::ctl {

struct EvaluationInputs {
  std::string tracking;
  std::vector<std::string> inertial;
  double tau = 0.0;           ///< [rad]
  double most_percent = 0.0;  ///< Time in error at most, of any limb, for the verdict "good" [%].
  std::vector<std::string> annotators;                           ///< Their files.
  std::vector<std::vector<evaluation::Annotation>> annotations;  ///< As many.
  std::optional<RefereedTake> reference = {};
};

[[nodiscard]] report::Report evaluation_report(const evaluation::Judgement& found,
                                               const EvaluationInputs& inputs);

/// Share of the judged time that a limb is in error [%].
[[nodiscard]] double error_percent(const evaluation::JudgedLimb& limb);

}  // namespace chorus::ctl
