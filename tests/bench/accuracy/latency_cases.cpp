#include "tests/bench/accuracy/latency_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/base/units.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/methods/registration_methods.h"
#include "tests/judge/joint_error.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using registration::WalkTrack;

constexpr std::size_t kLatencyDraws = 20;
constexpr std::size_t kQuickLatencyDraws = 2;
constexpr double kMillisecond = 1e3;
constexpr std::array kPlanted{std::chrono::milliseconds(0), std::chrono::milliseconds(20),
                              std::chrono::milliseconds(50)};

struct Case {
  std::string name;
  Setting setting;
  bool late = true;
};

/// What one draw came to, with latencies estimated, not estimated, and without any.
struct Draw {
  std::vector<double> off;     ///< Errors of the latencies [ms].
  std::vector<double> stated;  ///< Their stated standard deviations [ms].
  double applied = 0.0;        ///< Share of the sensors whose latency is taken off.
  double place_mm = kNoRatio;
  double place_unasked_mm = kNoRatio;
  double place_exact_mm = kNoRatio;
  double fused_mm = kNoRatio;
  double fused_unasked_mm = kNoRatio;
  double fused_exact_mm = kNoRatio;
};

Duration planted(std::size_t sensor, std::uint64_t seed) {
  return kPlanted[(sensor + seed) % kPlanted.size()];
}

std::vector<WalkTrack> late(const Workshop& workshop) {
  std::vector<WalkTrack> tracks = workshop.tracks;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (SensorFrame& frame : tracks[i].frames)
      move_in_time(frame, planted(i, workshop.setting.seed));
  }
  return tracks;
}

/// Registered and fused with these places; true places, so that latency is all that differs.
double fused_mm(const Workshop& workshop, std::vector<WalkTrack> tracks, const Latencies& found,
                Duration common) {
  Registration places = true_registration(workshop, workshop.tracks.front().sensor);
  places.latencies = found;
  // What all sensors are late by cannot be seen, and is not judged.
  for (WalkTrack& track : tracks) {
    for (SensorFrame& frame : track.frames) move_in_time(frame, -common);
  }
  const auto fused = pipeline::fuse_offline(tracks, places, {});
  if (!fused) return kNoRatio;
  return to_mm(fused_error(workshop, fused->snapshots, places.master).mean());
}

/// How late the sensor's stamps are in the middle of the walk, with what its host's clock is off.
Duration lateness(const Workshop& workshop, std::size_t sensor, bool is_late) {
  const Timestamp middle = workshop.begin + workshop.setting.length / 2;
  return workshop.clocks[sensor].host_time(middle) - middle +
         (is_late ? planted(sensor, workshop.setting.seed) : Duration{0});
}

void score_latencies(Draw& draw, const Workshop& workshop, const Latencies& told, bool is_late) {
  Duration common{0};
  for (std::size_t i = 0; i < workshop.tracks.size(); ++i) {
    const auto own = told.find(workshop.tracks[i].sensor);
    if (own != told.end() && own->second.sigma == Duration{0})
      common = lateness(workshop, i, is_late);
  }
  for (std::size_t i = 0; i < workshop.tracks.size(); ++i) {
    const auto own = told.find(workshop.tracks[i].sensor);
    if (own == told.end()) continue;
    draw.applied += own->second.applied ? 1.0 / static_cast<double>(workshop.tracks.size()) : 0.0;
    if (own->second.sigma == Duration{0}) continue;
    const Duration off = own->second.found - (lateness(workshop, i, is_late) - common);
    draw.off.push_back(kMillisecond * std::abs(seconds(off)));
    draw.stated.push_back(kMillisecond * seconds(own->second.sigma));
  }
}

/// The mean latency that is left.
Duration common_of(const Workshop& workshop, const Latencies& told) {
  Duration sum{0};
  for (std::size_t i = 0; i < workshop.tracks.size(); ++i) {
    sum += planted(i, workshop.setting.seed);
    const auto own = told.find(workshop.tracks[i].sensor);
    if (own != told.end()) sum += own->second.added();
  }
  return sum / static_cast<int>(workshop.tracks.size());
}

Draw one_draw(const Case& each, std::uint64_t seed) {
  Setting setting = each.setting;
  setting.seed = seed;
  const Workshop workshop = draw_workshop(setting);
  const auto tracks = each.late ? late(workshop) : workshop.tracks;
  registration::RegistrationConfig config;
  config.master = tracks.front().sensor;
  std::vector<SensorId> all;
  for (const WalkTrack& track : tracks) all.push_back(track.sensor);
  const auto place_mm = [&](const Registration& solved) {
    return to_mm(score_of(workshop, solved, all).position);
  };
  Draw draw;
  const Registration solved = solve(tracks, workshop.begin, config);
  score_latencies(draw, workshop, solved.latencies, each.late);
  draw.place_mm = place_mm(solved);
  config.latency_sigma = Duration{0};
  draw.place_unasked_mm = place_mm(solve(tracks, workshop.begin, config));
  draw.place_exact_mm = place_mm(solve(workshop.tracks, workshop.begin, config));
  const Duration none{0};
  draw.fused_exact_mm = fused_mm(workshop, workshop.tracks, {}, none);
  draw.fused_mm = fused_mm(workshop, tracks, solved.latencies,
                           each.late ? common_of(workshop, solved.latencies) : none);
  draw.fused_unasked_mm =
      each.late ? fused_mm(workshop, tracks, {}, common_of(workshop, {})) : draw.fused_exact_mm;
  return draw;
}

void report_draws(Report& report, const Case& each, const std::vector<Draw>& draws) {
  constexpr double kSigmas95 = 1.96;
  std::vector<double> off;
  std::vector<double> stated;
  std::size_t covered = 0;
  double applied = 0.0;
  for (const Draw& draw : draws) {
    for (std::size_t i = 0; i < draw.off.size(); ++i)
      covered += draw.off[i] <= kSigmas95 * draw.stated[i] ? 1U : 0U;
    off.insert(off.end(), draw.off.begin(), draw.off.end());
    stated.insert(stated.end(), draw.stated.begin(), draw.stated.end());
    applied += 100.0 * draw.applied / static_cast<double>(draws.size());
  }
  const auto row = [&](const char* metric, double value, const char* unit) {
    report.row(each.name, metric, value, unit);
  };
  if (off.empty()) return report.note(each.name + ": no latency was told");
  const double cover = 100.0 * static_cast<double>(covered) / static_cast<double>(off.size());
  row("latency_error_median_ms", median(off), "ms");
  row("latency_error_p95_ms", percentile(off, 0.95), "ms");
  row("latency_sigma_median_ms", median(stated), "ms");
  row("latency_in_95_percent", cover, "%");
  row("taken_off_percent", applied, "%");
  const auto middle = [&](double Draw::*value) {
    std::vector<double> values;
    for (const Draw& draw : draws) {
      if (std::isfinite(draw.*value)) values.push_back(draw.*value);
    }
    return values.empty() ? kNoRatio : median(values);
  };
  row("position_mm", middle(&Draw::place_mm), "mm");
  row("position_unasked_mm", middle(&Draw::place_unasked_mm), "mm");
  row("position_in_time_mm", middle(&Draw::place_exact_mm), "mm");
  row("fused_mm", middle(&Draw::fused_mm), "mm");
  row("fused_unasked_mm", middle(&Draw::fused_unasked_mm), "mm");
  row("fused_in_time_mm", middle(&Draw::fused_exact_mm), "mm");
  report.condition(each.name + ": 90 % and more of the latencies within 1.96 of their sigma",
                   cover >= 90.0);
}

}  // namespace

void measure_latencies(Report& report) {
  for (const char* profile : {"A", "B", "D"}) {
    for (const bool is_late : {true, false}) {
      for (const bool pair : {false, true}) {
        Case each;
        each.late = is_late;
        each.setting.profile = profile;
        if (pair) each.setting.places = pair_places(deg(90));
        each.name = fmt::format("latency-{}{}-30s-{}", is_late ? "" : "none-",
                                pair ? "pair" : "ring6", profile);
        const std::size_t draws = report.quick() ? kQuickLatencyDraws : kLatencyDraws;
        report_draws(report, each, over_draws(draws, [&](std::size_t i) {
                       return one_draw(each, report.seed() + i);
                     }));
      }
    }
  }
  report.note(
      "latency: sensors stamp 0, 20 and 50 ms late in turns (none: all in time), clocks taken for "
      "known; what those of a profile are off (B: 5 ms) counts as latency.  "
      "unasked: latency_sigma_ms 0; in_time: the same walks without latency.  Fused with true "
      "places; what all sensors are late by is not judged.");
}

}  // namespace chorus::bench
