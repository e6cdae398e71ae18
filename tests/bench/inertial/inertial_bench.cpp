// chorus-bench inertial: what inertial sensors are worth as judges of a tracker (Baak et al.), and
// what our filters, alignment and calibration reach on real recordings and on simulated ones.
#include <cstdlib>
#include <iostream>

#include "tests/bench/inertial/inertial_cases.h"

namespace chorus::bench {
namespace {

// clang-format off
constexpr InertialCase kCases[] = {
    {"calibrate", run_calibrate},   {"calibrate-real", run_calibrate_real},
    {"time-real", run_time_real},   {"detect", run_detect},
    {"detect-real", run_detect_real}, {"paper", run_paper},
    {"keraal", run_keraal},         {"filter", run_filter},
    {"residual-real", run_residual_real},
    {"fuse-hidden", run_fuse_hidden}, {"fuse-seen", run_fuse_seen},
    {"heading", run_heading},       {"suit-of-whom", run_suit_of_whom},
    {"cost", run_worn_cost},       {"witness", run_witness},
};
// clang-format on

}  // namespace

std::filesystem::path shared_recordings() {
  const char* const stated = std::getenv("CHORUS_SHARED");
  return std::filesystem::path(stated != nullptr ? stated : "../shared") / "data";
}

Result<void> run_inertial(Report& report) {
  bool found = report.only().empty();
  for (const InertialCase& each : kCases) {
    if (report.list()) std::cout << each.name << '\n';
    if (report.list() || (!report.only().empty() && report.only() != each.name)) continue;
    found = true;
    if (auto ok = each.run(report); !ok) return ok;
  }
  if (found || report.list()) return {};
  return fail(ErrorCode::InvalidArgument, "--only " + report.only(), "is no case; see --list");
}

}  // namespace chorus::bench
