#include "common/synthetic/kinect/error_source.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/unit/synthetic/kinect/room.h"

namespace chorus::synthetic::kinect {
namespace {

/// Names of the parameters that scaling `source` changes.
std::set<std::string> changed(Source source, double factor) {
  const auto before = parameters_of(nominal_profile("B"));
  const auto after = parameters_of(with_source(nominal_profile("B"), source, factor));
  std::set<std::string> names;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (std::abs(before[i].value - after[i].value) > 1e-12) names.emplace(before[i].name);
  }
  return names;
}

TEST(WithSource, OneLeavesEverything) {
  for (const Source source : kAllSources) EXPECT_TRUE(changed(source, 1.0).empty());
}

TEST(WithSource, TouchesItsOwnParametersOnly) {
  const std::array<const char*, 8> prefixes{"visibility.", "yaw.",   "bias.",     "coloured.",
                                            "white.",      "gross.", "delivery.", "clock."};
  for (std::size_t i = 0; i < kAllSources.size(); ++i) {
    for (const double factor : {0.0, 0.5, 2.0, 3.0}) {
      const auto names = changed(kAllSources[i], factor);
      EXPECT_FALSE(names.empty()) << prefixes[i] << factor;
      for (const std::string& name : names) EXPECT_TRUE(name.starts_with(prefixes[i])) << name;
    }
  }
}

/// Effect of a profile on a minute of frames: distances of seen joints from the true joints of the
/// same name [m], counts, and the largest error of a stamp [s].
struct Effect {
  double worst = 0.0;
  double mean = 0.0;
  std::size_t inferred = 0;
  std::size_t frames = 0;
  std::size_t bodies = 0;
  double clock = 0.0;
};

Effect effect_of(const Profile& profile) {
  const Scene scene = room();
  KinectSensor sensor(scene, setting(profile), kStart);
  const Eigen::Isometry3d sensor_from_world = scene.world_from_sensor[0].inverse();
  Effect effect;
  std::size_t seen = 0;
  while (sensor.next_exposure() < kStart + std::chrono::seconds(60)) {
    const Timestamp exposed = sensor.next_exposure();
    const auto frame = sensor.next();
    if (!frame) continue;
    ++effect.frames;
    effect.bodies += frame->bodies.size();
    effect.clock = std::max(effect.clock, std::abs(seconds(frame->captured - exposed)));
    if (frame->bodies.empty()) continue;
    const auto exact = to_sensor(sensor_from_world, truth(scene, 0, exposed));
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const Joint& joint = frame->bodies[0].skeleton.joints[i];
      if (!joint.seen()) continue;
      const double error = (joint.position - exact.joints[i].position).norm();
      effect.worst = std::max(effect.worst, error);
      effect.mean += error;
      ++seen;
      effect.inferred += joint.state == JointState::Inferred;
    }
  }
  effect.mean /= static_cast<double>(seen);
  return effect;
}

TEST(WithSource, AllOffIsThePlainTruth) {
  const Effect none = effect_of(perfect());
  EXPECT_LT(none.worst, 1e-9);
  EXPECT_LT(none.clock, 1e-9);
  EXPECT_GT(none.frames, 1800u) << "every frame arrives";
  EXPECT_GT(none.bodies, none.frames * 9 / 10) << "only outside the view is nobody";
}

/// A profile in which only this source is on.
Profile only(Source source) {
  Profile profile = nominal_profile("B");
  for (const Source each : kAllSources) {
    if (each != source) profile = with_source(std::move(profile), each, 0.0);
  }
  return profile;
}

TEST(WithSource, EachAloneDoesItsOwnHarm) {
  const Effect none = effect_of(perfect());
  EXPECT_GT(effect_of(only(Source::Visibility)).inferred, 10 * none.inferred + 100);
  EXPECT_GT(effect_of(only(Source::Visibility)).worst, mm(40)) << "hidden joints are guessed";
  EXPECT_GT(effect_of(only(Source::Yaw)).worst, 0.2) << "exchanged labels";
  const double bias = effect_of(only(Source::Bias)).worst;
  EXPECT_GT(bias, mm(15));
  EXPECT_LT(bias, mm(150));
  EXPECT_GT(effect_of(only(Source::Coloured)).worst, mm(50));
  const double white = effect_of(only(Source::White)).worst;
  EXPECT_GT(white, mm(20));
  EXPECT_LT(white, mm(250));
  EXPECT_GT(effect_of(only(Source::Gross)).worst, 0.2);
  const Effect delivery = effect_of(only(Source::Delivery));
  EXPECT_LT(delivery.frames, none.frames);
  EXPECT_LT(delivery.bodies, delivery.frames);
  EXPECT_LT(delivery.worst, 1e-9);
  const Effect clock = effect_of(only(Source::Clock));
  EXPECT_GT(clock.clock, 1e-4);
  EXPECT_LT(clock.worst, 1e-9) << "the stamp errs, not the place";
}

/// Strength of the effect of this source, in a unit that depends on the source.
double harm(Source source, const Effect& effect) {
  if (source == Source::Clock) return effect.clock;
  if (source == Source::Delivery) return -static_cast<double>(effect.bodies);
  return effect.mean;
}

TEST(WithSource, MoreOfItIsMoreErrorOverTheWholeSweep) {
  for (std::size_t i = 0; i < kAllSources.size(); ++i) {
    double before = -std::numeric_limits<double>::infinity();
    for (const double factor : {0.0, 0.5, 1.0, 2.0, 3.0}) {
      const double now = harm(kAllSources[i],
                              effect_of(with_source(only(kAllSources[i]), kAllSources[i], factor)));
      EXPECT_GT(now, before) << "source " << i << " x" << factor;
      before = now;
    }
  }
}

TEST(WithSource, TheYawShownFallsBackMoreAndMoreButNeverTurnsBackwards) {
  double before = deg(90);
  for (const double factor : {0.5, 1.0, 2.0, 3.0}) {
    const YawBehaviour yaw = with_source(nominal_profile("A"), Source::Yaw, factor).yaw;
    const double shown = shown_yaw(deg(90), yaw.hip_slope, yaw);
    EXPECT_LT(shown, before) << factor;
    EXPECT_GT(shown, yaw.reliable) << factor;
    before = shown;
  }
}

TEST(WithSource, LeftAndRightAreExchangedEarlierTheMoreYawErrs) {
  double rear = deg(361);
  for (const double factor : {0.0, 0.5, 1.0, 2.0, 3.0}) {
    const YawBehaviour yaw = with_source(nominal_profile("A"), Source::Yaw, factor).yaw;
    EXPECT_LT(yaw.flip_to_rear, rear) << factor;
    EXPECT_LE(yaw.flip_to_front, yaw.flip_to_rear) << factor;
    EXPECT_GT(yaw.flip_to_front, yaw.reliable) << factor;
    rear = yaw.flip_to_rear;
  }
}

TEST(WithSource, WhatNeverExchangesLeftAndRightNeverDoes) {
  for (const double factor : {0.5, 1.0, 2.0, 3.0}) {
    EXPECT_GE(with_source(nominal_profile("D"), Source::Yaw, factor).yaw.flip_to_rear, deg(180));
  }
}

}  // namespace
}  // namespace chorus::synthetic::kinect
