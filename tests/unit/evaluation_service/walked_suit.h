// A person who walks, and a suit that says how each limb is turned; with a slip after a time.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/evaluation/limb_frame.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/exercise.h"
#include "common/synthetic/scene.h"
#include "services/evaluation/live_judge.h"
#include "tests/support/builders.h"

namespace chorus::testing {

inline synthetic::Scene exercising_pair() {
  synthetic::Scene scene{kStart, synthetic::make_people({}, 2), {}, {}};
  for (synthetic::Person& person : scene.people) person = synthetic::exercising(person);
  return scene;
}

struct WalkedSuit {
  std::vector<inertial::Limb> limbs{inertial::Limb::Chest, inertial::Limb::ForearmLeft,
                                    inertial::Limb::ThighLeft};
  /// By how much the left forearm's sensor has turned across the bone, by seconds.
  std::function<double(double)> slip = [](double) { return 0.0; };
  std::string prefix = {};  ///< Of the sensors' names.
  std::size_t wearer = 0;
  synthetic::Scene scene = exercising_pair();

  [[nodiscard]] Skeleton<WorldSpace> body(double t) const {
    return synthetic::truth(scene, wearer, kStart + from_seconds(t));
  }
  [[nodiscard]] std::string name(inertial::Limb limb) const {
    return prefix.empty() ? std::string(inertial::name_of(limb))
                          : prefix + std::to_string(inertial::index_of(limb));
  }
  [[nodiscard]] inertial::InertialFrame instant(double t) const {
    inertial::InertialFrame frame{
        sensor_id("suit"), static_cast<std::uint64_t>(100 * t), kStart + from_seconds(t), {}, {}};
    const auto person = body(t);
    for (const inertial::Limb limb : limbs) {
      const auto own = static_cast<double>(inertial::index_of(limb));
      auto& reading = frame.readings.emplace_back();
      reading.sensor = name(limb);
      reading.captured = frame.captured;
      Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
      if (limb == inertial::Limb::ForearmLeft) turned = exp_map({slip(t), 0.0, 0.0});
      if (const auto tracked = evaluation::limb_from_joints(person, limb))
        reading.inertial_from_sensor = about_y(own) * tracked->world_from_limb * turned *
                                       exp_map({0.3 * own, 1.0, -0.2 * own});
    }
    return frame;
  }
  [[nodiscard]] evaluation_service::TrackedInstant tracked(double t) const {
    return {kStart + from_seconds(t), {{PersonId{7}, body(t)}}};
  }
};

/// Lets the judge see `from` to `to` seconds: a tracker with 30 Hz, sensors with 60.
inline void walk(evaluation_service::LiveJudge& judge, const WalkedSuit& suit, double from,
                 double to) {
  for (double t = from; t < to; t += 1.0 / 30.0) {
    judge.take(suit.instant(t));
    judge.take(suit.instant(t + 1.0 / 60.0));
    judge.take(suit.tracked(t + 0.005));
    (void)judge.judge();
  }
}

/// The judgement on a limb; a default one if there is none.
inline evaluation_service::LimbJudgement on(const evaluation_service::LiveJudge& judge,
                                            inertial::Limb limb) {
  for (const auto& each : judge.limbs()) {
    if (each.limb == limb) return each;
  }
  return {};
}

}  // namespace chorus::testing
