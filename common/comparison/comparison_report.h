// A comparison as a report: what was found, what each figure means.
#pragma once

#include <string>

#include "common/comparison/comparison.h"
#include "common/report/report.h"

namespace chorus::comparison {

struct Compared {
  std::string a;  ///< Names of the two recordings.
  std::string b;
  std::vector<std::string> notes;  ///< What was left out while reading.
};

[[nodiscard]] report::Report report_of(const Comparison& comparison, const Compared& what);

}  // namespace chorus::comparison
