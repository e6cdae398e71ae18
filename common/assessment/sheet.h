// The assessment sheet: one page a method, laid out in the order of the paper form and filled from
// the worst held posture, with the timeline and the three worst postures.  Self-contained HTML that
// prints; each field says whether it was measured, asked or is unknown, and can be corrected by
// hand without losing what was measured.
#pragma once

#include <string>

#include "common/assessment/score_documents.h"

namespace chorus::assessment {

enum class Language { English, German };

struct SheetPerson {
  const AssessedPerson& person;
  const std::vector<ergonomics::BodyAt>& bodies;  ///< Those that were scored, for the pictures.
};

/// A page for each method of each person.
[[nodiscard]] std::string sheet_html(const Assessment& assessment,
                                     const std::vector<SheetPerson>& persons, Language language);

}  // namespace chorus::assessment
