// chorus-bench ergonomics: whether tables and laws are right, how far scores agree with those of
// the truth, whether the stated doubt has the right size, and what scoring costs.
#include <iostream>

#include "tests/bench/ergonomics/ergonomics_cases.h"

namespace chorus::bench {

Result<void> run_ergonomics(Report& report);

Result<void> run_ergonomics(Report& report) {
  struct Case {
    const char* name;
    Result<void> (*run)(Report&);
    bool quick;
  };
  constexpr Case kCases[]{{"tables", posture_tables, true},
                          {"laws", posture_laws, true},
                          {"real-vicon", posture_real_vicon, false},
                          {"uiprmd", posture_uiprmd, false},
                          {"simulated", posture_simulated, false},
                          {"cost", posture_cost, true},
                          {"prop", held_box, false}};
  for (const Case& each : kCases) {
    if (report.list()) {
      std::cout << each.name << '\n';
      continue;
    }
    if (!report.only().empty() ? report.only() != each.name : report.quick() && !each.quick)
      continue;
    if (const auto done = each.run(report); !done) return done;
  }
  return {};
}

}  // namespace chorus::bench
