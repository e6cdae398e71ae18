// People who walk from cell to cell.  But for four cases with real processes, the cells are
// simulated at the level of what they publish: sixty-four simulated sensors are more than one
// machine can fuse.
#include <array>
#include <iostream>

#include "tests/bench/site/site_cases.h"

namespace chorus::bench {
namespace {

struct SiteCase {
  const char* name;
  Result<void> (*run)(Report&);
};

template <void (*kRun)(Report&)>
Result<void> always(Report& report) {
  kRun(report);
  return {};
}

template <const char* const* kName>
Result<void> real(Report& report) {
  return run_real_case(report, *kName);
}
constexpr const char* kLine = "line-4x4";
constexpr const char* kLost = "lost";
constexpr const char* kFaults = "faults";
constexpr const char* kReaders = "readers";
constexpr const char* kStreams = "streams";

constexpr std::array kSiteCases{SiteCase{"hall-8x8", always<run_hall_case>},
                                SiteCase{"hand-over", always<run_hand_over_case>},
                                SiteCase{"site-places", run_places_case},
                                SiteCase{kLine, real<&kLine>},
                                SiteCase{kLost, real<&kLost>},
                                SiteCase{kFaults, real<&kFaults>},
                                SiteCase{kReaders, real<&kReaders>},
                                SiteCase{kStreams, real<&kStreams>}};

}  // namespace

Result<void> run_site(Report& report) {
  for (const SiteCase& each : kSiteCases) {
    if (report.list()) {
      std::cout << each.name << '\n';
      continue;
    }
    if (!report.only().empty() && report.only() != each.name) continue;
    if (const Result<void> done = each.run(report); !done) return done;
  }
  report.note(
      "But for line-4x4, lost, faults, readers and streams, simulated at the level of what cells "
      "publish: a cell never confuses two of its own people, and loses nobody within its area.");
  return {};
}

}  // namespace chorus::bench
