// A simulated suit says what its limbs do, and errs by what it is told to, no more.
#include "common/synthetic/simulated_suit.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "common/synthetic/coloured_noise.h"
#include "common/synthetic/suit_errors.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::synthetic {
namespace {

using chorus::testing::IsOk;
using chorus::testing::sensor_id;
using inertial::InertialReading;
using inertial::Limb;
using Kind = SuitFault::Kind;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Timestamp kSuitStart = chorus::testing::kStart;

SimulatedSuit exact_suit(int sensors = 13) {
  SimulatedSuit suit;
  suit.scene.epoch = kSuitStart;
  suit.scene.people = make_people({}, 1);
  suit.limbs = limbs_of_suit(sensors);
  suit.errors.noise = 0.0;
  return suit;
}

SuitFault fault_of(Kind kind, Limb limb, double size = 0.0) {
  SuitFault fault;
  fault.kind = kind;
  fault.limb = limb;
  fault.begin = seconds(2);
  fault.size = size;
  return fault;
}

std::optional<InertialReading> said_by(const SimulatedSuit& suit, Limb limb, Duration after,
                                       std::uint64_t number = 1) {
  for (auto& each : suit_at(suit, kSuitStart, kSuitStart + after, number).readings)
    if (each.sensor == suit_sensor_name(limb)) return each;
  return std::nullopt;
}

/// The angle between the limb and what its sensor predicts of it with the true calibration.
double prediction_off(const SimulatedSuit& suit, Limb limb, Duration after,
                      std::uint64_t number = 1) {
  const auto calibration = true_calibration(suit, sensor_id("suit"));
  const auto* const sensor = find_sensor(calibration, suit_sensor_name(limb));
  const auto reading = said_by(suit, limb, after, number);
  const auto bone = true_limb(truth(suit.scene, 0, kSuitStart + after), limb);
  if (sensor == nullptr || !reading || !reading->inertial_from_sensor || !bone) return 1e9;
  return angular_distance(*bone, predicted_limb(*sensor, *reading->inertial_from_sensor));
}

TEST(SimulatedSuit, IsTakenBackToEveryLimbByItsTrueCalibration) {
  for (const int sensors : {5, 6, 13}) {
    const SimulatedSuit suit = exact_suit(sensors);
    ASSERT_EQ(suit.limbs.size(), static_cast<std::size_t>(sensors));
    for (const Limb limb : suit.limbs)
      EXPECT_LT(prediction_off(suit, limb, milliseconds(700)), 1e-6) << name_of(limb);
    EXPECT_THAT(inertial::checked(suit_at(suit, kSuitStart, kSuitStart + milliseconds(700), 7)),
                IsOk());
  }
}

TEST(SimulatedSuit, NoiseIsAsLargeAsTold) {
  SimulatedSuit suit = exact_suit(6);
  suit.errors.noise = deg(2.0);
  double sum = 0.0;
  for (std::uint64_t i = 0; i < 500; ++i)
    sum += std::pow(prediction_off(suit, Limb::ShankLeft, milliseconds(10 * i), i), 2);
  EXPECT_NEAR(to_deg(std::sqrt(sum / 500.0 / 3.0)), 2.0, 0.15);
}

TEST(SimulatedSuit, SkinMovesByItsLimbsRowAndNeighboursAreAlike) {
  SimulatedSuit suit = exact_suit();
  suit.errors.skin = 1.0;
  const SkinRow row = skin_of(Limb::UpperArmLeft);
  const auto about = [&](double t) { return log_map(skin_error(suit, Limb::UpperArmLeft, t)).y(); };
  double square = 0.0, together = 0.0, apart = 0.0;
  constexpr int kInstants = 4000;
  for (int i = 0; i < kInstants; ++i) {
    const double t = 0.15 * i;
    square += std::pow(about(t), 2);
    together += about(t) * about(t + 0.1 * row.tau);
    apart += about(t) * about(t + 10.0 * row.tau);
  }
  EXPECT_NEAR(std::sqrt(square / kInstants) / row.twist, 1.0, 0.15);
  EXPECT_GT(together / square, 0.8);
  EXPECT_LT(std::abs(apart / square), 0.3);
  suit.errors.skin = 0.0;
  EXPECT_LT(prediction_off(suit, Limb::UpperArmLeft, seconds(3)), 1e-6);
}

TEST(SimulatedSuit, ForearmsTurnFarWithTheirHandsButSeldom) {
  SimulatedSuit suit = exact_suit();
  suit.errors.skin = 1.0;
  int beyond_six = 0, beyond_twenty = 0;
  for (int i = 0; i < 4000; ++i) {
    const double off = to_deg(std::abs(pronation(suit, Limb::ForearmLeft, 0.15 * i)));
    beyond_six += off > 6.0 ? 1 : 0;
    beyond_twenty += off > 20.0 ? 1 : 0;
  }
  EXPECT_NEAR(beyond_six / 4000.0, 0.32, 0.08);
  EXPECT_NEAR(beyond_twenty / 4000.0, 0.13, 0.06);
  EXPECT_EQ(pronation(suit, Limb::HandLeft, 1.0), 0.0) << "a hand does not turn against itself";
  EXPECT_GT(prediction_off(suit, Limb::ForearmLeft, seconds(3)), 1e-4);
}

TEST(SimulatedSuit, AnIntegralGrowsByItsNoise) {
  const ColouredNoise noise(Draw{7}, 3.0);
  double sum = 0.0;
  for (int i = 0; i < 10000; ++i) sum += noise.at(1e-3 * (i + 0.5)) * 1e-3;
  EXPECT_NEAR(noise.integral(10.0), sum, 1e-4);
}

TEST(SimulatedSuit, HeadingsDriftOnlyWithoutMagnetometer) {
  SimulatedSuit suit = exact_suit();
  suit.errors.heading_drift = deg(0.3);
  double worst = 0.0;
  for (const Limb limb : suit.limbs)
    worst = std::max(worst, prediction_off(suit, limb, seconds(100)));
  EXPECT_GT(to_deg(worst), 15.0);
  EXPECT_LE(to_deg(worst), 30.0 + 1e-6);
  EXPECT_EQ(said_by(suit, Limb::Chest, seconds(1))->magnetic, inertial::MagneticState::None);
  suit.errors.magnetometer = true;
  EXPECT_LT(prediction_off(suit, Limb::Chest, seconds(100)), 1e-6);
}

TEST(SimulatedSuit, ABiasThatWandersTurnsTheHeadingAndKeepsTheTilt) {
  SimulatedSuit suit = exact_suit();
  suit.errors.bias_walk = deg(0.2);
  const double off = heading_error(suit, Limb::Pelvis, 60.0);
  EXPECT_GT(std::abs(to_deg(off)), 0.1);
  EXPECT_NEAR(prediction_off(suit, Limb::Pelvis, seconds(60)), std::abs(off), 1e-6);
}

TEST(SimulatedSuit, IronTurnsTheHeadingForAWhileAndTheSensorSaysSo) {
  SimulatedSuit suit = exact_suit();
  suit.errors.magnetometer = true;
  suit.faults.push_back(fault_of(Kind::Disturbance, Limb::Pelvis, deg(40.0)));
  suit.faults.back().end = seconds(8);
  EXPECT_NEAR(to_deg(prediction_off(suit, Limb::Pelvis, seconds(5))), 40.0, 1e-6);
  EXPECT_EQ(said_by(suit, Limb::Pelvis, seconds(5))->magnetic, inertial::MagneticState::Disturbed);
  EXPECT_LT(prediction_off(suit, Limb::Pelvis, seconds(9)), 1e-6);
  EXPECT_EQ(said_by(suit, Limb::Pelvis, seconds(9))->magnetic,
            inertial::MagneticState::Undisturbed);
}

TEST(SimulatedSuit, SlipsWhenItIsToldAndStays) {
  SimulatedSuit suit = exact_suit();
  suit.faults.push_back(fault_of(Kind::Slip, Limb::ForearmLeft, deg(60.0)));
  EXPECT_LT(prediction_off(suit, Limb::ForearmLeft, milliseconds(1990)), 1e-6);
  EXPECT_NEAR(to_deg(prediction_off(suit, Limb::ForearmLeft, milliseconds(2400))), 60.0, 1e-6);
  EXPECT_NEAR(to_deg(prediction_off(suit, Limb::ForearmLeft, seconds(500))), 60.0, 1e-6);
  EXPECT_LT(prediction_off(suit, Limb::ForearmRight, seconds(3)), 1e-6);
}

TEST(SimulatedSuit, FallsSilentByFaultAndByItsBattery) {
  SimulatedSuit suit = exact_suit();
  suit.faults.push_back(fault_of(Kind::Silence, Limb::ShankLeft));
  suit.faults.back().end = seconds(4);
  suit.faults.push_back(fault_of(Kind::BatteryDeath, Limb::ShankRight));
  EXPECT_TRUE(said_by(suit, Limb::ShankLeft, seconds(1)));
  EXPECT_FALSE(said_by(suit, Limb::ShankLeft, seconds(3)));
  EXPECT_TRUE(said_by(suit, Limb::ShankLeft, seconds(5)));
  EXPECT_NEAR(said_by(suit, Limb::ShankRight, seconds(1))->battery.value(), 0.5, 1e-6);
  EXPECT_FALSE(said_by(suit, Limb::ShankRight, seconds(3)));
  EXPECT_GT(said_by(suit, Limb::Pelvis, seconds(5))->battery.value(), 0.99);
}

TEST(SimulatedSuit, SwappedSensorsFeelEachOthersLimbsUntilTheEnd) {
  SimulatedSuit suit = exact_suit();
  const auto before = said_by(suit, Limb::ThighRight, seconds(3))->inertial_from_sensor->coeffs();
  suit.faults.push_back(fault_of(Kind::Swap, Limb::ThighLeft));
  suit.faults.back().other = Limb::ThighRight;
  EXPECT_EQ(said_by(suit, Limb::ThighLeft, seconds(3))->inertial_from_sensor->coeffs(), before);
  EXPECT_LT(prediction_off(suit, Limb::ThighLeft, seconds(1)), 1e-6);
}

TEST(SimulatedSuit, MayLieAboutItsCovarianceWithoutErringMore) {
  SimulatedSuit suit = exact_suit();
  suit.errors.noise = deg(2.0);
  const auto honest = said_by(suit, Limb::Chest, seconds(3));
  suit.faults.push_back(fault_of(Kind::Lie, Limb::Chest, 0.1));
  const auto lying = said_by(suit, Limb::Chest, seconds(3));
  EXPECT_EQ(honest->inertial_from_sensor->coeffs(), lying->inertial_from_sensor->coeffs());
  EXPECT_NEAR((*honest->covariance)(0, 0) / (*lying->covariance)(0, 0), 100.0, 1e-6);
}

TEST(SimulatedSuit, ChipsMeasureTheRateThatTurnsTheSensorAndGravityAtRest) {
  SimulatedSuit suit = exact_suit();
  suit.raw = true;
  const auto before = said_by(suit, Limb::ShankLeft, milliseconds(995));
  const auto now = said_by(suit, Limb::ShankLeft, milliseconds(1000));
  const auto after = said_by(suit, Limb::ShankLeft, milliseconds(1005));
  ASSERT_TRUE(now->rate && now->acceleration);
  const Eigen::Vector3d turned =
      log_map(before->inertial_from_sensor->conjugate() * *after->inertial_from_sensor) / 0.01;
  EXPECT_LT((*now->rate - turned).norm(), 0.05 + 0.15 * turned.norm());
  double mean = 0.0;
  for (int i = 0; i < 300; ++i)
    mean += said_by(suit, Limb::Chest, milliseconds(100 * i))->acceleration->norm() / 300.0;
  EXPECT_NEAR(mean, 9.81, 0.7);
}

TEST(SimulatedSuit, SaysTheSameOfTheSameSeedOnly) {
  SimulatedSuit suit = exact_suit();
  suit.errors = {deg(2.0), 1.0, false, deg(0.1), deg(0.1)};
  const auto said = [&](std::uint64_t number) {
    return said_by(suit, Limb::ForearmLeft, seconds(9), number)->inertial_from_sensor->coeffs();
  };
  const auto first = said(4);
  EXPECT_EQ(said(4), first);
  EXPECT_NE(said(5), first);
  suit.seed = 2;
  EXPECT_NE(said(4), first);
}

}  // namespace
}  // namespace chorus::synthetic
