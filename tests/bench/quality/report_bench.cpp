// chorus-bench report: what `chorus report` and `chorus compare` say, beside the truth.
#include <array>
#include <iostream>

#include "tests/bench/quality/report_cases.h"

namespace chorus::bench {
namespace {

struct ReportCase {
  std::string_view name;
  Result<void> (*run)(Report&);
  bool quick;  ///< Also part of a smoke test.
};

constexpr std::array kReportCases{
    ReportCase{"counts", &report_counts, true}, ReportCase{"noise", &report_noise, false},
    ReportCase{"faults", &report_faults, true}, ReportCase{"compare", &compared_pairs, true},
    ReportCase{"hour", &report_hour, false},
};

}  // namespace

Result<void> run_report(Report& report) {
  bool any = false;
  for (const ReportCase& each : kReportCases) {
    const bool chosen =
        report.only().empty() ? each.quick || !report.quick() : report.only() == each.name;
    if (!chosen) continue;
    any = true;
    if (report.list()) {
      std::cout << each.name << '\n';
    } else if (auto done = each.run(report); !done) {
      return done;
    }
  }
  if (!any)
    return fail(ErrorCode::InvalidArgument, report.only(), "there is no such case; see --list");
  return {};
}

}  // namespace chorus::bench
