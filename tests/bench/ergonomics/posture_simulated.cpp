// Simulated: six sensors around somebody at assembly work, with the car and the pillar.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "fusion-server/pipeline/offline.h"
#include "tests/bench/ergonomics/ergonomics_cases.h"
#include "tests/bench/ergonomics/posture_agreement.h"
#include "tests/judge/crowd.h"
#include "tests/judge/judge.h"

namespace chorus::bench {
namespace {

Setting assembly_setting(const std::string& profile, std::uint64_t seed) {
  Setting setting;
  setting.profile = profile;
  setting.seed = seed;
  setting.people = worker_beside_car(seed);
  setting.occluders = {car_body(), pillar()};
  setting.length = std::chrono::seconds(40);
  return setting;
}

ergonomics::BodyAt simulated_body(const FusedBody& fused, Timestamp at) {
  ergonomics::BodyAt body{at, fused.skeleton, fused.sides_confidence.value_or(1.0),
                          fused.carried_for.has_value()};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Joint& joint = body.body.joints[j];
    if (!joint.covariance.known() && fused.variance[j] > 0.0)
      joint.covariance = Covariance(Eigen::Matrix3d::Identity() * fused.variance[j]);
  }
  return body;
}

Result<ScoredTake> simulated_take(const Workshop& workshop, std::optional<std::size_t> only) {
  const SensorId master = workshop.tracks.front().sensor;
  Registration places = true_registration(workshop, master);
  std::vector<registration::WalkTrack> tracks = workshop.tracks;
  if (only) {
    tracks = {workshop.tracks[*only]};
    std::erase_if(places.sensors, [&](const auto& each) { return each.first != tracks[0].sensor; });
  }
  const auto result = pipeline::fuse_offline(tracks, places, {});
  if (!result) return pass(result);
  ScoredTake take;
  for (const Snapshot& snapshot : result->snapshots) {
    const Timestamp at = snapshot.instant;
    take.truth.push_back({at, true_body(workshop, 0, at, master)});
    take.found.push_back(snapshot.bodies.empty() ? ergonomics::BodyAt{at, {}}
                                                 : simulated_body(snapshot.bodies.front(), at));
  }
  return take;
}

/// A sensor that never sees the person (no ratio) is none of the best.
double level_of_sensor(const PostureAgreement& sensor) {
  const double level = sensor.of[1].weighted_kappa();
  return std::isnan(level) ? -1.0 : level;
}

}  // namespace

Result<void> posture_simulated(Report& report) {
  const std::size_t draws = report.quick() ? 1 : 3;
  for (const std::string profile : {"A", "B", "C", "D"}) {
    PostureAgreement fused;
    PostureAgreement instant;
    std::array<PostureAgreement, 6> single;
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
      const Workshop workshop = draw_workshop(assembly_setting(profile, report.seed() + draw));
      const auto take = simulated_take(workshop, std::nullopt);
      if (!take) return pass(take);
      compare_postures(*take, {}, fused);
      compare_postures(*take, {.held = false}, instant);
      for (std::size_t s = 0; s < std::min(single.size(), workshop.tracks.size()); ++s) {
        const auto alone = simulated_take(workshop, s);
        if (!alone) return pass(alone);
        compare_postures(*alone, {}, single[s]);
      }
    }
    const auto best = std::ranges::max_element(single, {}, level_of_sensor);
    report_agreement(report, "simulated-" + profile, fused);
    report_doubt(report, "simulated-" + profile, fused);
    report_doubt(report, fmt::format("simulated-{}-instant", profile), instant);
    report_agreement(report, fmt::format("simulated-{}-best-sensor", profile), *best);
    report.condition(
        fmt::format("simulated-{}: REBA level, weighted kappa at least 0.85 (is {:.2f})", profile,
                    fused.of[1].weighted_kappa()),
        fused.of[1].weighted_kappa() >= 0.85);
  }
  report.note(
      "simulated: assembly work beside a car and a pillar, true places; simulator numbers; the "
      "best "
      "sensor is chosen afterwards, by its level at the instants that it scores");
  return {};
}

}  // namespace chorus::bench
