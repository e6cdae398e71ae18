// Cameras without depth: identities from rays alone, four views of a real person from landmarks and
// from pixels, and how many pictures a second the runner that comes with Chorus processes.
#include <array>
#include <iostream>
#include <string_view>

#include "tests/bench/camera/four_views.h"

namespace chorus::bench {
namespace {

struct Case {
  std::string_view name;
  Result<void> (*run)(Report&);
  bool quick;  ///< Part of the smoke test.
};
constexpr std::array kCases{Case{"people", simulated_people, true},
                            Case{"four-views", four_views, true},
                            Case{"distance", placed_people, true},
                            Case{"four-views-live", live_views, false},
                            Case{"eight-views-vicon", eight_views, false},
                            Case{"video", runner_speed, false},
                            Case{"one-left", one_left, false},
                            Case{"rays-alone", rays_alone, false},
                            Case{"calibrate", lens_calibration, false}};

}  // namespace

Result<void> run_camera(Report& report) {
  bool any = false;
  for (const Case& each : kCases) {
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
