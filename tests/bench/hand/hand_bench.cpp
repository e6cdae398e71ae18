// chorus-bench hand: hands from scans, and gloves before a camera.
#include <array>
#include <iostream>

#include "tests/bench/hand/hand_cases.h"

namespace chorus::bench {
namespace {

struct HandCase {
  std::string_view name;
  Result<void> (*run)(Report&);
  bool quick;  ///< Also part of a smoke test.
};

constexpr std::array kHandCases{
    HandCase{"synthetic", &synthetic_hands, true},
    HandCase{"refused", &things_refused, false},
    HandCase{"photos", &hand_photos, false},
    HandCase{"silhouettes", &hand_silhouettes, false},
    HandCase{"repeats", &repeated_drawings, false},
    HandCase{"repeats-real", &repeated_silhouettes, false},
    HandCase{"speed", &scan_speed, false},
    HandCase{"glove", &glove_places, true},
};

}  // namespace

Result<void> run_hand(Report& report) {
  bool any = false;
  for (const HandCase& each : kHandCases) {
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
