#include "fusion-server/fusion/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "fusion-server/fusion/point_filter.h"

namespace chorus::fusion {
namespace {

constexpr Timestamp kMotionStart = from_unix_ns(1'790'000'000'000'000'000);
constexpr MotionFilter::Densities kDensities{0.001, 10.0};
constexpr double kMotionSigma = 0.01;     // [m]
constexpr double kMotionStep = 1.0 / 30;  // [s]

Timestamp at_motion_step(int i) { return kMotionStart + from_seconds(kMotionStep * i); }

/// Place of a point at step i: at rest for a second, then moving away at a constant speed [m/s].
double place(int i, double speed) { return i < 30 ? 0.0 : speed * kMotionStep * (i - 30); }

/// Errors at each of 60 steps, over many draws.
struct Errors {
  /// Mean squared error per axis [m^2].
  std::vector<double> squared = std::vector<double>(60, 0.0);
  std::vector<double> variance = std::vector<double>(60, 0.0);  ///< Mean stated variance [m^2].
};

template <class Filter, class Variance>
Errors errors_of(const Filter& fresh, double speed, const Variance& variance) {
  constexpr int kDraws = 400;
  Errors errors;
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, kMotionSigma);
  for (int draw = 0; draw < kDraws; ++draw) {
    Filter filter = fresh;
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d truth(place(i, speed), 0, 0);
      const Eigen::Vector3d seen =
          truth + Eigen::Vector3d(noise(random), noise(random), noise(random));
      filter.update(at_motion_step(i), seen, kMotionSigma * kMotionSigma);
      const auto [position, stated] = variance(filter, at_motion_step(i));
      errors.squared[i] += (position - truth).squaredNorm() / 3 / kDraws;
      errors.variance[i] += stated / kDraws;
    }
  }
  return errors;
}

Errors of_mixed(double speed, const MotionFilter::Densities& densities = kDensities) {
  return errors_of(MotionFilter(densities), speed, [](const MotionFilter& filter, Timestamp at) {
    const auto motion = filter.at(at).value();
    return std::pair(motion.position, motion.variance);
  });
}

Errors of_single(double speed, double density) {
  return errors_of(PointFilter(density), speed, [](const PointFilter& filter, Timestamp at) {
    return std::pair(*filter.at(at), filter.position_variance());
  });
}

double rms(const Errors& errors, int from, int to) {
  double sum = 0.0;
  for (int i = from; i < to; ++i) sum += errors.squared[i];
  return std::sqrt(sum / (to - from));
}

double stated(const Errors& errors, int from, int to) {
  double sum = 0.0;
  for (int i = from; i < to; ++i) sum += errors.variance[i];
  return std::sqrt(sum / (to - from));
}

TEST(MotionFilter, IsNearlyAsSmoothAtRestAsTheStiffFilter) {
  const Errors mixed = of_mixed(0.0);
  EXPECT_LT(rms(mixed, 20, 30), 0.7 * rms(of_single(0.0, kDensities.moving), 20, 30));
  EXPECT_LT(rms(mixed, 20, 30), 1.6 * rms(of_single(0.0, kDensities.resting), 20, 30));
}

TEST(MotionFilter, FollowsAStartAsQuicklyAsTheAgileFilterAndIsSmootherAfterwards) {
  for (const double speed : {0.5, 1.0, 2.0}) {  // [m/s]
    const Errors mixed = of_mixed(speed);
    const Errors agile = of_single(speed, kDensities.moving);
    EXPECT_LT(rms(mixed, 30, 33), 1.1 * rms(agile, 30, 33)) << speed;
    EXPECT_LT(rms(mixed, 33, 40), 1.0 * rms(agile, 33, 40)) << speed;
    EXPECT_LT(rms(mixed, 40, 60), 0.75 * rms(agile, 40, 60)) << speed;
  }
}

TEST(MotionFilter, StatesItsErrorsAlsoWhileItDoesNotKnowWhetherThePointMoves) {
  const Errors start = of_mixed(0.5);
  EXPECT_GT(stated(start, 30, 33), 0.85 * rms(start, 30, 33));
  for (const double speed : {0.0, 1.0}) {
    const Errors errors = of_mixed(speed);
    EXPECT_GT(stated(errors, 20, 30), 0.95 * rms(errors, 20, 30));
    EXPECT_LT(stated(errors, 20, 30), 1.25 * rms(errors, 20, 30));
    EXPECT_LT(stated(errors, 40, 60), 1.25 * rms(errors, 40, 60));
  }
}

TEST(MotionFilter, IsTheSingleFilterWhereBothDensitiesAreEqual) {
  const Errors mixed = of_mixed(1.0, {3.0, 3.0});
  const Errors single = of_single(1.0, 3.0);
  for (int i = 0; i < 60; ++i) {
    EXPECT_NEAR(std::sqrt(mixed.squared[i]), std::sqrt(single.squared[i]), 2e-4) << i;
    // Of 400 draws, a few are clipped at some step, and are less sure after it.
    EXPECT_NEAR(mixed.variance[i], single.variance[i], 0.01 * single.variance[i]) << i;
  }
}

/// Raised and lowered by 1.2 m within half a second, at up to 7.5 m/s, then half a second of rest.
double swung(int i) {
  const double phase = std::fmod(kMotionStep * i, 1.0);
  return phase < 0.5 ? 1.2 * std::sin(std::numbers::pi * phase / 0.5) : 0.0;
}

TEST(MotionFilter, FollowsAHandThatIsFasterThanExpected) {
  MotionFilter filter(kDensities);
  double rest = 0.0;
  double worst = 0.0;
  for (int i = 0; i < 150; ++i) {
    filter.update(at_motion_step(i), {0, swung(i), 0}, 1e-5);
    const double error = std::abs(filter.at(at_motion_step(i))->position.y() - swung(i));
    worst = std::max(worst, error);
    if (std::fmod(kMotionStep * i, 1.0) > 0.75) rest = std::max(rest, error);
  }
  EXPECT_LT(worst, 0.35);
  EXPECT_LT(rest, 0.01);
}

TEST(MotionFilter, HardlyFollowsASingleOutlierAndIsNoSurerForIt) {
  MotionFilter filter(kDensities);
  for (int i = 0; i < 60; ++i) filter.update(at_motion_step(i), {0, 0, 0}, 1e-5);
  const double before = filter.at(at_motion_step(59))->variance;
  filter.update(at_motion_step(60), {0, 0.5, 0}, 1e-5);
  const auto after = filter.at(at_motion_step(60)).value();
  EXPECT_LT(after.position.y(), 0.08);
  EXPECT_GT(after.variance, 5.0 * before);
}

TEST(MotionFilter, AnUnseenPointSlowsDownAndIsLessAndLessSure) {
  MotionFilter filter(kDensities);
  EXPECT_FALSE(filter.at(kMotionStart));
  for (int i = 0; i < 60; ++i) filter.update(at_motion_step(i), {0.05 * i, 0, 0}, 1e-6);  // 1.5 m/s
  const auto seen = filter.at(at_motion_step(59)).value();
  const auto soon = filter.at(at_motion_step(62)).value();
  const auto late = filter.at(at_motion_step(59 + 90)).value();
  EXPECT_NEAR(seen.motion.velocity.x(), 1.5, 0.05);
  EXPECT_NEAR(soon.position.x(), 0.05 * 62, 0.03);
  EXPECT_NEAR(late.position.x() - seen.position.x(), 1.5 * 0.4,
              0.05);  // the speed times the time constant
  EXPECT_LT(late.motion.velocity.x(), 0.01);
  EXPECT_LT(seen.variance, soon.variance);
  EXPECT_LT(soon.variance, late.variance);
}

}  // namespace
}  // namespace chorus::fusion
