#include "tests/bench/methods/registration_methods.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "tests/bench/methods/pair_estimators.h"
#include "tests/judge/place_error.h"

namespace chorus::bench {
namespace {

Setting white_noise(std::vector<Eigen::Isometry3d> places, int length) {
  Setting setting;
  setting.profile = "gauss";
  setting.places = std::move(places);
  setting.length = std::chrono::seconds(length);
  return setting;
}

std::vector<SensorId> all_of(const Workshop& workshop) {
  std::vector<SensorId> sensors;
  for (const auto& track : workshop.tracks) sensors.push_back(track.sensor);
  return sensors;
}

TEST(Score, TheTruthIsWithoutErrorAndTheMasterIsNotCounted) {
  const Workshop workshop = draw_workshop(white_noise(ring_places(synthetic::Ring{}), 0));
  const Registration exact = true_registration(workshop, workshop.tracks[0].sensor);
  const Score score = score_of(workshop, exact, all_of(workshop));
  EXPECT_EQ(score.asked, 5u);
  EXPECT_EQ(score.refused, 0u);
  EXPECT_EQ(score.lost, 0u);
  EXPECT_NEAR(score.position_worst, 0.0, 1e-12);
  EXPECT_NEAR(score.centre, 0.0, 1e-12);
}

TEST(Score, ARefusedSensorLeavesNoErrorAndALostOneIsCounted) {
  const Workshop workshop = draw_workshop(white_noise(ring_places(synthetic::Ring{}), 0));
  Registration solved = true_registration(workshop, workshop.tracks[0].sensor);
  solved.sensors.at(workshop.tracks[2].sensor).world_from_sensor.translation().x() += 0.3;
  const Score lost = score_of(workshop, solved, all_of(workshop));
  EXPECT_EQ(lost.lost, 1u);
  EXPECT_NEAR(lost.position, 0.3 / 5.0, 1e-12);
  EXPECT_NEAR(lost.position_worst, 0.3, 1e-12);
  solved.sensors.erase(workshop.tracks[3].sensor);
  const Score refused = score_of(workshop, solved, all_of(workshop));
  EXPECT_EQ(refused.refused, 1u);
  EXPECT_TRUE(std::isnan(refused.position));
}

TEST(Score, TheEllipseHoldsWhatItsCovarianceSays) {
  const Workshop workshop = draw_workshop(white_noise(pair_places(deg(90)), 0));
  Registration solved = true_registration(workshop, workshop.tracks[0].sensor);
  Extrinsics& place = solved.sensors.at(workshop.tracks[1].sensor);
  place.covariance = mm(10) * mm(10) * Eigen::Matrix<double, 6, 6>::Identity();
  place.world_from_sensor.translation().x() += mm(24);  // 95 % in two dimensions: 2.45 sigma
  EXPECT_EQ(score_of(workshop, solved, all_of(workshop)).covered, 1u);
  place.world_from_sensor.translation().x() += mm(1);
  EXPECT_EQ(score_of(workshop, solved, all_of(workshop)).covered, 0u);
}

TEST(Baselines, FindAPairUnderWhiteNoise) {
  const Workshop workshop = draw_workshop(white_noise(pair_places(deg(90)), 10));
  for (const RegistrationMethod& method : timed_baselines()) {
    const Registration solved =
        method.solve(workshop.tracks, workshop.begin, workshop.tracks[0].sensor);
    const Score score = score_of(workshop, solved, all_of(workshop));
    EXPECT_EQ(score.refused, 0u) << method.name;
    EXPECT_LT(score.position, mm(60)) << method.name;
  }
}

TEST(Baselines, RefuseWhereTheTwoShareTooLittle) {
  const Workshop workshop = draw_workshop(white_noise(pair_places(deg(90)), 1));
  for (const RegistrationMethod& method : timed_baselines()) {
    const Registration solved =
        method.solve(workshop.tracks, workshop.begin, workshop.tracks[0].sensor);
    EXPECT_EQ(score_of(workshop, solved, all_of(workshop)).refused, 1u) << method.name;
  }
}

TEST(RowOfFour, OnlyNeighboursEverShareTheWalk) {
  Setting setting = row_of_four();
  setting.profile = "gauss";
  const Workshop workshop = draw_workshop(setting);
  registration::RegistrationConfig config;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = i + 1; k < 4; ++k) {
      const auto edge = register_pair(workshop.tracks[i], workshop.tracks[k], config);
      EXPECT_EQ(edge.has_value(), k == i + 1) << i << " and " << k;
    }
  }
}

}  // namespace
}  // namespace chorus::bench
