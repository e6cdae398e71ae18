#include "tests/bench/faults/trial.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace chorus::bench {
namespace {

constexpr double kRate = 30.0;  // [Hz]
// Tolerance of the number of frames, because those at both ends are uncertain.
constexpr double kMaxOff = 3.0;
constexpr double kMinShare = 97.0;  // [percent]
constexpr double kMaxGap = 0.35;    // between two frames: the alignment delay and a margin [s]

}  // namespace

void Trial::check_others(Cell& cell, const Account& account,
                         const std::vector<std::string>& others) {
  lost = static_cast<double>(account.lost);
  output_hz = account.hz;
  age_p90_ms = 1e3 * account.age_p90;
  rss_mb = cell.fusion().resident_mb();
  check(cell.fusion().alive() && cell.ask({"GET", "/healthz"}).status != 0,
        "the server stands and answers");
  const double off = account.hz == 0.0
                         ? kRate
                         : (account.hz - kRate) * static_cast<double>(account.frames) / account.hz;
  check(std::abs(off) <= kMaxOff, fmt::format("30 Hz: {:.1f}", account.hz));
  check(account.lost == 0, fmt::format("no instant without its body: {}", account.lost));
  check(account.longest_gap < kMaxGap,
        fmt::format("no pause above {} s: {:.2f}", kMaxGap, account.longest_gap));
  for (const std::string& name : others) {
    const double share = account.share_of(name);
    others_percent = std::isnan(others_percent) ? share : std::min(others_percent, share);
    check(share >= kMinShare, fmt::format("{} is in {:.0f} % of the frames", name, share));
  }
}

void Trial::check_recovery(double took, double limit) {
  recover_s = took;
  check(took <= limit, fmt::format("all contribute again within {} s: {:.2f}", limit, took));
}

}  // namespace chorus::bench
