// The figures of a method in a contest.
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "tests/bench/methods/contest.h"
#include "tests/judge/plausibility.h"
#include "tests/judge/stated_error.h"

namespace chorus::bench {
namespace {

constexpr double kPercent = 100.0;
constexpr double kToMs = 1000.0;

template <class Of>
Metric in_mm(std::string name, Of of) {
  return {std::move(name), "mm", [of](const Answers& a) { return to_mm(of(a)); }};
}
template <class Of>
Metric in_percent(std::string name, Of of) {
  return {std::move(name), "%", [of](const Answers& a) { return kPercent * of(a); }};
}

template <JointGroup kGroup, double (*kOf)(const Answers&, JointGroup)>
double of_group(const Answers& answers) {
  return kOf(answers, kGroup);
}

std::vector<Metric> error_metrics() {
  using enum JointGroup;
  return {in_mm("mpjpe_mm", of_group<All, mpjpe>),
          in_mm("centre_mm", of_group<Centre, mpjpe>),
          in_mm("extremities_mm", of_group<Extremities, mpjpe>),
          in_mm("bias_free_mm", of_group<All, bias_free_mpjpe>),
          in_mm("jitter_core_mm", of_group<Centre, jitter_at_rest>),
          in_mm("jitter_extremity_mm", of_group<Extremities, jitter_at_rest>),
          in_percent("bone_cv_percent", bone_variation),
          in_percent("bone_length_error_percent", bone_length_error),
          in_mm("foot_slide_mm", foot_slide),
          {"jumps_per_minute", "1/min", jumps_per_minute},
          in_percent("flip_percent", label_error_share),
          in_percent("limb_flip_percent", limb_label_error_share),
          {"latency_ms", "ms", [](const Answers& a) { return kToMs * latency(a); }},
          in_mm("hold50_mm", held_error),
          in_percent("missing_percent", [](const Answers& a) { return 1.0 - coverage(a); })};
}

struct NamedSighted {
  std::string suffix;
  Sighted which;
};

/// The groups of joints: all of them, and then by how many views saw them, combined with whether
/// they are at rest.
std::vector<NamedSighted> sighted_apart() {
  using enum Sighted::Motion;
  std::vector<NamedSighted> all{{"", {}}};
  for (const auto& [views, least, most] :
       {std::tuple{"_1_view", 1, 1}, std::tuple{"_2_views", 2, 2},
        std::tuple{"_more_views", 3, 1000}}) {
    for (const auto& [motion, which] : {std::pair{"_rest", Rest}, std::pair{"_moving", Moving}}) {
      all.push_back({std::string(views) + motion,
                     {static_cast<std::size_t>(least), static_cast<std::size_t>(most), which}});
    }
  }
  return all;
}

std::vector<Metric> stated_metrics() {
  std::vector<Metric> all;
  for (const auto& [suffix, which] : sighted_apart()) {
    const auto add = [&, asked = which](const char* name, const char* unit, double scale,
                                        double (*of)(const Answers&, const Sighted&)) {
      all.push_back({name + suffix, unit, [=](const Answers& a) { return scale * of(a, asked); },
                     Kind::Stated});
    };
    add("nees", "", 1.0, nees);
    add("ball95_percent", "%", kPercent, ball95_share);
    add("sharpness", "", 1.0, sharpness);
  }
  return all;
}

std::vector<Metric> all_metrics() {
  std::vector<Metric> all = error_metrics();
  for (Metric& each : stated_metrics()) all.push_back(std::move(each));
  return all;
}

}  // namespace

std::span<const Metric> metrics() {
  static const std::vector<Metric> kMetrics = all_metrics();
  return kMetrics;
}

}  // namespace chorus::bench
