// How well a sensor host's clock is known: the clock model alone on simulated exchanges, with a
// worse network and clock, and with parts of the filter left out; then how much its corrections
// improve fused bodies.
#include <array>
#include <functional>

#include <fmt/format.h>

#include "common/base/units.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/accuracy/time_clock.h"
#include "tests/bench/methods/comparison.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/methods/stress.h"
#include "tests/judge/joint_error.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kDraws = 20;
constexpr std::size_t kQuickDraws = 4;
constexpr double kMillisecond = 1e3;

struct Metric {
  const char* name;
  double ClockErrors::*value;
};
constexpr std::array kMetrics{
    Metric{"rms_ms", &ClockErrors::rms}, Metric{"p95_ms", &ClockErrors::p95},
    Metric{"p99_ms", &ClockErrors::p99}, Metric{"deviation_ms", &ClockErrors::deviation}};
constexpr const Metric& kShort = kMetrics[1];

using Draws = std::vector<std::vector<ClockErrors>>;

Draws draw_all(const Report& report, const ClockCase& each,
               const std::vector<NamedClock>& methods) {
  return over_draws(report.quick() ? kQuickDraws : kDraws,
                    [&](std::size_t i) { return clock_errors(each, methods, report.seed() + i); });
}

Comparison compare(const std::string& name, const Metric& metric, const Draws& draws,
                   const std::vector<NamedClock>& methods) {
  Comparison comparison(name, metric.name, "ms");
  for (std::size_t i = 0; i < draws.size(); ++i) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      comparison.add(methods[m].name, i, draws[i][m].*metric.value);
    }
  }
  return comparison;
}

void measure_clock(Report& report, const ClockCase& each) {
  const auto methods = clock_methods();
  const Draws draws = draw_all(report, each, methods);
  for (const Metric& metric : kMetrics) {
    compare(each.name, metric, draws, methods).report(report);
  }
  report.note(fmt::format("{}: aimed at: {}.", each.name, each.target));
  report.condition(
      fmt::format("{}: p95 below {} ms", each.name, each.ceiling_ms),
      compare(each.name, kShort, draws, methods).spread_of(kOurs).median < each.ceiling_ms);
  if (each.step == 0.0) return;
  const Comparison after =
      compare(each.name, {"after_step_ms", &ClockErrors::after_step}, draws, methods);
  after.report(report);
  report.condition(fmt::format("{}: below 1 ms from 10 s after the step on", each.name),
                   after.spread_of(kOurs).high < 1.0);
}

/// A source of error in a clock or in the network to it.
struct ClockSource {
  const char* name;
  void (*scale)(ClockCase&, double factor);
};
constexpr std::array kClockSources{
    ClockSource{"jitter", [](ClockCase& c, double f) { c.network.jitter *= f; }},
    ClockSource{"spikes", [](ClockCase& c, double f) { c.network.spike *= f; }},
    ClockSource{"asymmetry", [](ClockCase& c, double f) { c.network.asymmetry *= f; }},
    ClockSource{"offset", [](ClockCase& c, double f) { c.offset *= f; }},
    ClockSource{"drift", [](ClockCase& c, double f) { c.drift *= f; }}};

/// Varies each source in the wired office network, where requests take half a millisecond longer
/// than answers.
void sweep(Report& report) {
  const auto methods = clock_methods();
  for (const ClockSource& source : kClockSources) {
    for (const double factor : kFactors) {
      ClockCase each = clock_case("lan");
      constexpr double kAsymmetry = 0.5e-3;
      each.network.asymmetry = kAsymmetry;
      source.scale(each, factor);
      const std::string name = fmt::format("sweep-{}-x{}", source.name, factor);
      compare(name, kShort, draw_all(report, each, methods), methods).report(report);
    }
  }
}

/// What each part of the filter contributes: `ours` is the whole filter, every other row leaves one
/// part out or shortens the window.
void ablate(Report& report) {
  const auto methods = clock_ablations();
  for (const char* name : {"lan-ntp", "lan", "wifi", "device-390ppm", "ntp-step"}) {
    compare(std::string("ablation-") + name, kShort, draw_all(report, clock_case(name), methods),
            methods)
        .report(report);
  }
}

/// Fused errors of one draw [mm]: stamps corrected, stamps as given, and (`exact`) hosts with only
/// the small clock errors of the profile, as NTP leaves them.
struct FusedErrors {
  double corrected = 0.0;
  double uncorrected = 0.0;
  double exact = 0.0;
};

double fused_mm(const Workshop& workshop, const std::vector<registration::WalkTrack>& tracks) {
  const Registration places = true_registration(workshop, workshop.tracks.front().sensor);
  const auto fused = pipeline::fuse_offline(tracks, places, {});
  if (!fused) return kNoRatio;
  return to_mm(fused_error(workshop, fused->snapshots, places.master).mean());
}

FusedErrors fused_draw(std::uint64_t seed, double clock_offset) {
  Setting setting;
  setting.seed = seed;
  setting.length = std::chrono::seconds(10);
  FusedErrors errors;
  const Workshop right = draw_workshop(setting);
  errors.exact = fused_mm(right, right.tracks);
  setting.clock_offset = clock_offset;
  setting.clock_drift = 50e-6;
  const Workshop off = draw_workshop(setting);
  errors.uncorrected = fused_mm(off, off.tracks);
  errors.corrected = fused_mm(off, with_corrected_clocks(off, clock_case("lan").network));
  return errors;
}

void measure_fusion(Report& report, double clock_offset) {
  const std::size_t draws = report.quick() ? 1 : kDraws;
  const auto found =
      over_draws(draws, [&](std::size_t i) { return fused_draw(report.seed() + i, clock_offset); });
  Comparison comparison(fmt::format("fused6-off-{:.0f}ms-A", kMillisecond * clock_offset),
                        "mpjpe_mm", "mm");
  for (std::size_t i = 0; i < found.size(); ++i) {
    comparison.add(kOurs, i, found[i].corrected);
    comparison.add("uncorrected", i, found[i].uncorrected);
    comparison.add("ntp-0.1ms", i, found[i].exact);
  }
  comparison.report(report);
}

}  // namespace

Result<void> run_time(Report& report) {
  report.profile(described({"A"}));
  for (const ClockCase& each : clock_cases()) measure_clock(report, each);
  if (!report.quick()) {
    sweep(report);
    ablate(report);
  }
  for (const double offset : {0.02, 0.1}) measure_fusion(report, offset);
  report.note(
      "Simulated exchanges, 30 a second for 120 s, errors from 10 s on.  least-delay: what the "
      "server did before, the least delay of the last 30 s, applied where it is larger than its "
      "uncertainty.");
  report.note(
      "fused6: the ring of six, 10 s, true places, hosts off by up to so much and 50 ppm; stamps "
      "corrected as the server does it, beside the same uncorrected and hosts within 0.1 ms.");
  return {};
}

}  // namespace chorus::bench
