// Where rendered gloves are whose pose is told, and how sure the answer is.
#include <cmath>
#include <ctime>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "common/base/units.h"
#include "common/hand/glove.h"
#include "common/hand/size_check.h"
#include "common/synthetic/draw.h"
#include "tests/bench/hand/hand_cases.h"
#include "tests/bench/hand/hand_methods.h"
#include "tests/bench/report/plot.h"
#include "tests/support/hands/glove_scene.h"

namespace chorus::bench {
namespace {

using hand::GloveOptions;

struct GloveCase {
  const char* name;
  double distance;  // [m]
  double tilt;      // [rad]
  double size;      // of the true hand, relative to the skeleton
  double sigma;     // of the size, as stated
  bool clutter = false;
};
constexpr std::array kGloveCases{
    GloveCase{"glove-0.6m-facing", 0.6, 0.0, 1.0, 0.01},
    GloveCase{"glove-0.6m-facing-size+1%", 0.6, 0.0, 1.01, 0.01},
    GloveCase{"glove-0.6m-facing-size-1%", 0.6, 0.0, 0.99, 0.01},
    GloveCase{"glove-0.6m-any-size+1%", 0.6, deg(60.0), 1.01, 0.01},
    GloveCase{"glove-1.2m-facing-size+1%", 1.2, 0.0, 1.01, 0.01},
    GloveCase{"glove-0.6m-facing-size+3%", 0.6, 0.0, 1.03, 0.03},
    GloveCase{"glove-1.2m-facing-size+3%", 1.2, 0.0, 1.03, 0.03},
    GloveCase{"glove-0.6m-facing-dark-things", 0.6, 0.0, 1.0, 0.01, true}};

struct GloveScores {
  double squares = 0.0, nees_along = 0.0, nees_across = 0.0;
  std::vector<double> errors;
  std::size_t shown = 0;

  [[nodiscard]] double rms_mm() const {
    return 1000.0 * std::sqrt(squares / static_cast<double>(errors.size()));
  }
};

GloveScores score_of(const GloveCase& of, bool refine, std::uint64_t seed, std::uint64_t draws) {
  GloveScores out;
  GloveOptions options;
  options.refine = refine;
  options.size_sigma = of.sigma;
  for (std::uint64_t i = 0; i < draws; ++i) {
    const hand::Skeleton skeleton = testing::usual_skeleton();
    const auto seen = testing::seen_glove(
        skeleton, {seed + i, of.distance, of.tilt, of.size, deg(5.0), of.clutter});
    ++out.shown;
    const auto place = hand::place_glove(hand::glove_mask(seen.grey, options),
                                         {skeleton, seen.pose}, seen.camera, options);
    if (!place) continue;
    const Eigen::Vector3d off = place->wrist - seen.wrist;
    const Eigen::Vector3d sight = seen.wrist.normalized();
    const double along = sight.dot(off), across = off.squaredNorm() - along * along;
    const double variance = sight.dot(place->covariance * sight);
    out.squares += off.squaredNorm();
    out.errors.push_back(1000.0 * off.norm());
    out.nees_along += along * along / variance;
    out.nees_across += across / std::max(1e-12, place->covariance.trace() - variance);
  }
  return out;
}

void add_rows(Report& report, const GloveCase& of, std::uint64_t draws) {
  const GloveScores ours = score_of(of, true, report.seed(), draws),
                    circles = score_of(of, false, report.seed(), draws);
  const double count = static_cast<double>(ours.errors.size());
  report.row(of.name, "rms_mm", ours.rms_mm(), "mm", "circles (Eqs. 3, 4)",
             ours.rms_mm() / circles.rms_mm());
  report.row(of.name, "p95_mm", share_quantile(ours.errors, 0.95), "mm");
  report.row(of.name, "circles_rms_mm", circles.rms_mm(), "mm");
  report.row(of.name, "answered_percent", 100.0 * count / static_cast<double>(ours.shown), "%");
  report.row(of.name, "nees_along", ours.nees_along / count, "1");
  report.row(of.name, "nees_across", ours.nees_across / count, "1");
}

/// Fig. 15: the error by distance.
Result<void> by_distance(Report& report, std::uint64_t draws) {
  Plot plot{"Glove: error of the wrist by distance", {"distance [m]"}, {"RMS error [mm]"}, {}};
  for (const auto& [name, refine, size] : {std::tuple{"circles (Eqs. 3, 4)", false, 1.0},
                                           {"with the outline", true, 1.0},
                                           {"with the outline, size 1 % wrong", true, 1.01}}) {
    Series series{name, Mark::Line, {}};
    for (const double distance : {0.4, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0}) {
      const GloveCase of{"", distance, 0.0, size, 0.01};
      const double rms = score_of(of, refine, report.seed() + 500, draws).rms_mm();
      series.points.emplace_back(distance, rms);
      report.row(fmt::format("glove-by-distance-{:.1f}m", distance), fmt::format("rms_mm {}", name),
                 rms, "mm");
    }
    plot.series.push_back(std::move(series));
  }
  if (report.plots().empty()) return {};
  return write_svg(plot, report.plots(), "glove_distance");
}

/// A wrong size, where something else tells the distance to 20 mm, once a second for 20 s.
void add_told(Report& report, std::uint64_t trials) {
  constexpr std::uint64_t kSeconds = 20;
  constexpr double kOther = 0.02;  // [m]
  for (const double size : {1.0, 1.01, 1.03}) {
    double told = 0.0;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
      std::vector<double> by_hand, by_other;
      synthetic::Draw draw({report.seed(), trial, 83});
      for (std::uint64_t i = 0; i < kSeconds; ++i) {
        const hand::Skeleton skeleton = testing::usual_skeleton();
        const testing::GloveScene scene{report.seed() + 1000 + 100 * trial + i,
                                        draw.uniform(0.5, 1.2),
                                        deg(30.0),
                                        size,
                                        deg(5.0),
                                        false};
        const auto seen = testing::seen_glove(skeleton, scene);
        const auto place =
            hand::place_glove(hand::glove_mask(seen.grey, {}), {skeleton, seen.pose}, seen.camera);
        if (!place) continue;
        by_hand.push_back(place->wrist.norm());
        by_other.push_back(seen.wrist.norm() + kOther * draw.gauss());
      }
      if (hand::check_size(by_hand, by_other, 1.0).wrong()) told += 1.0;
    }
    report.row(fmt::format("glove-size{:+.0f}%", 100.0 * (size - 1.0)), "told_wrong_percent",
               100.0 * told / static_cast<double>(trials), "%");
  }
}

void add_speed(Report& report) {
  constexpr int kFrames = 40;
  const hand::Skeleton skeleton = testing::usual_skeleton();
  const auto seen = testing::seen_glove(skeleton, {});
  for (const bool refine : {true, false}) {
    GloveOptions options;
    options.refine = refine;
    const std::clock_t before = std::clock();
    for (int i = 0; i < kFrames; ++i)
      (void)hand::place_glove(hand::glove_mask(seen.grey, options), {skeleton, seen.pose},
                              seen.camera, options);
    const double used = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    report.row("glove-speed", refine ? "per_second" : "circles_per_second", kFrames / used, "1/s");
  }
}

}  // namespace

Result<void> glove_places(Report& report) {
  const std::uint64_t draws = report.quick() ? 3 : 60;
  for (const GloveCase& each : kGloveCases) {
    add_rows(report, each, draws);
    if (report.quick()) break;
  }
  report.note(
      "glove: rendered at 640 x 480 (focal length 600 pixels), joint angles 5 degrees off, six "
      "iterations; any pose: turned up to 60 degrees away");
  if (report.quick()) return {};
  add_speed(report);
  add_told(report, 12);
  return by_distance(report, 30);
}

}  // namespace chorus::bench
