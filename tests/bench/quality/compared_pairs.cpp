// Pairs of recordings of one motion, whose errors are independent.
#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/comparison/comparison.h"
#include "common/geometry/rotation.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/quality/report_cases.h"
#include "tests/bench/quality/simulated_day.h"

namespace chorus::bench {
namespace {

using comparison::People;

/// What is done to B.
struct Change {
  Eigen::Isometry3d world = Eigen::Isometry3d::Identity();
  double later = 0.0;  ///< [s]
};

/// Times are those of the room, which both recordings share.
People people_of(const FusedFrames& frames, Timestamp origin, const Change& change) {
  People out;
  for (const auto& frame : frames)
    for (const auto& body : frame.bodies) {
      comparison::Moment moment;
      moment.time = seconds(frame.captured - origin) + change.later;
      for (std::size_t j = 0; j < kJointCount; ++j) {
        moment.body.joints[j] = body.joints[j];
        moment.body.joints[j].position = change.world * body.joints[j].position;
      }
      out[body.id].push_back(std::move(moment));
    }
  return out;
}

struct Pair {
  FusedFrames a;
  FusedFrames b;
};

/// The same room records one motion twice; the sensors' errors are drawn anew.
Result<Pair> pair_of(std::uint64_t seed) {
  DaySetting setting;
  setting.work.profile = seed % 2 == 0 ? "gauss" : "A";
  setting.work.seed = seed;
  setting.work.length = std::chrono::seconds(60);
  auto first = simulated_day(setting);
  if (!first) return pass(first);
  setting.errors = seed + 1000;
  auto second = simulated_day(setting);
  if (!second) return pass(second);
  return Pair{std::move(first->fused), std::move(second->fused)};
}

/// 5 mm along a drawn direction on the floor, or 2 deg about the vertical through the middle.
Change planted(std::uint64_t draw) {
  std::mt19937_64 random(draw);
  std::uniform_real_distribution<double> angle(-3.14, 3.14);
  Change change;
  if (draw % 2 == 0) {
    const double way = angle(random);
    change.world.translation() = 0.005 * Eigen::Vector3d(std::cos(way), 0.0, std::sin(way));
  } else {
    change.world.linear() = about_y(angle(random) > 0 ? deg(2) : deg(-2)).toRotationMatrix();
  }
  return change;
}

struct PairOutcome {
  std::string identical;  ///< The first difference that was claimed; empty: none.
  bool planted_found = false;
  double lag_error = 0.0;     ///< [s]
  double offset_error = 0.0;  ///< [m]
};

Result<PairOutcome> compared(std::uint64_t seed) {
  const auto pair = pair_of(seed);
  if (!pair) return pass(pair);
  const Timestamp begin = pair->a.front().captured;
  const People a = people_of(pair->a, begin, {});
  PairOutcome out;
  const auto same = comparison::compare(a, people_of(pair->b, begin, {}));
  if (!same) return pass(same);
  if (!same->differences.empty()) out.identical = same->differences.front();
  const auto other = comparison::compare(a, people_of(pair->b, begin, planted(seed)));
  if (!other) return pass(other);
  out.planted_found = !other->differences.empty();
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> drawn(-0.5, 0.5);
  Change change;
  change.later = drawn(random);
  change.world.translation() = Eigen::Vector3d(drawn(random), 0.0, drawn(random));
  const auto moved =
      comparison::compare(a, people_of(pair->b, begin, change), {.clock_range = 2.0});
  if (!moved) return pass(moved);
  out.lag_error = std::abs(moved->lag + change.later);
  for (int axis = 0; axis < 3; ++axis)
    out.offset_error =
        std::max(out.offset_error, std::abs(moved->offset[static_cast<std::size_t>(axis)].mean +
                                            change.world.translation()[axis]));
  return out;
}

}  // namespace

Result<void> compared_pairs(Report& report) {
  const std::size_t draws = report.quick() ? 1 : 20;
  const auto all =
      over_draws(draws, [&](std::size_t draw) { return compared(report.seed() + draw); });
  std::size_t different = 0;
  std::size_t found = 0;
  double lag = 0.0;
  double offset = 0.0;
  for (const auto& each : all) {
    if (!each) return pass(each);
    if (!each->identical.empty()) report.note("identical, but: " + each->identical);
    different += each->identical.empty() ? 0U : 1U;
    found += each->planted_found ? 1U : 0U;
    lag = std::max(lag, each->lag_error);
    offset = std::max(offset, each->offset_error);
  }
  const std::string of = fmt::format("of {}", draws);
  report.row("compare", "identical_called_different", static_cast<double>(different), of);
  report.row("compare", "planted_found", static_cast<double>(found), of);
  report.row("compare", "worst_lag_error", 1e3 * lag, "ms");
  report.row("compare", "worst_offset_error", to_mm(offset), "mm");
  report.condition(
      fmt::format("compare: no identical pair is called different ({} {})", different, of),
      different == 0);
  report.condition(fmt::format("compare: 5 mm or 2 deg are always found ({} {})", found, of),
                   found == draws);
  report.condition(fmt::format("compare: lag within 5 ms (worst {:.2f})", 1e3 * lag), lag <= 0.005);
  report.condition(fmt::format("compare: offset within 2 mm (worst {:.2f})", to_mm(offset)),
                   offset <= 0.002);
  return {};
}

}  // namespace chorus::bench
