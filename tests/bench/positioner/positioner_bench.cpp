// chorus-bench positioner: where people in inertial suits are, seen by one camera or two.
#include <array>
#include <iostream>

#include "tests/bench/positioner/positioner_cases.h"

namespace chorus::bench {
namespace {

struct PositionerCase {
  std::string_view name;
  Result<void> (*run)(Report&);
  bool quick;  ///< Also part of a smoke test.
};

constexpr std::array kPositionerCases{
    PositionerCase{"eight-views-vicon", &eight_views_alone, true},
    PositionerCase{"two-of-eight", &eight_views_pairs, false},
    PositionerCase{"walk", &rendered_walk, true},
    PositionerCase{"slide", &rendered_slide, false},
    PositionerCase{"occlusion", &rendered_occlusion, false},
    PositionerCase{"light", &rendered_light, false},
    PositionerCase{"two-cameras", &rendered_two_cameras, false},
    PositionerCase{"shape", &shape_gain, false},
    PositionerCase{"speed", &sight_speed, false},
    PositionerCase{"pets", &pets_walkers, false},
    PositionerCase{"four-views", &four_views_pixels, false},
};

}  // namespace

Result<void> run_positioner(Report& report) {
  bool any = false;
  for (const PositionerCase& each : kPositionerCases) {
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
