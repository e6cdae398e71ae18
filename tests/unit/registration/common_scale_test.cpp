#include "fusion-server/registration/common_scale.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "fusion-server/registration/guessed_depth.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kTrueScale = 1.07;
constexpr double kChain = 1.3004;  // of person_at(): ankle to knee to hip to shoulders [m]
constexpr double kStature = kChain / 0.779;
constexpr int kCameras = 4;

/// What a camera would send that takes the person for smaller than they are.
WalkTrack guessed(WalkTrack track, double scale = kTrueScale) {
  for (SensorFrame& frame : track.frames) {
    frame.floor.reset();
    for (Joint& joint : frame.bodies[0].skeleton.joints) {
      joint.position /= scale;
      const Eigen::Vector3d ray = joint.position.normalized();
      const double along = 0.06 * joint.position.norm();
      joint.covariance = Covariance(Eigen::Matrix3d(mm(25) * mm(25) * Eigen::Matrix3d::Identity() +
                                                    along * along * ray * ray.transpose()));
    }
  }
  return track;
}

std::vector<WalkTrack> cameras() {
  std::vector<WalkTrack> walk;
  for (int i = 0; i < kCameras; ++i)
    walk.push_back(guessed(watch(i, ring_place(1.4 * i), {.length = 6, .noise = 0.0})));
  return walk;
}

/// Where the cameras stand, in units of the guess.
Registration exact() {
  Registration found;
  found.verdict = Verdict::Good;
  found.master = sensor(0);
  for (int i = 0; i < kCameras; ++i) {
    Eigen::Isometry3d place = ring_place(1.4 * i);
    place.translation() /= kTrueScale;
    found.sensors[sensor(i)].world_from_sensor = place;
    found.verdicts[sensor(i)].verdict = Verdict::Good;
  }
  return found;
}

double true_distance(int a, int b) {
  return (ring_place(1.4 * a).translation() - ring_place(1.4 * b).translation()).norm();
}

double distance(const Registration& found, int a, int b) {
  return (found.sensors.at(sensor(a)).world_from_sensor.translation() -
          found.sensors.at(sensor(b)).world_from_sensor.translation())
      .norm();
}

TEST(GuessedDepth, IsWhatCovariancesSayThatAreLongAlongTheLineOfSight) {
  const WalkTrack plain = watch(0, ring_place(0.0), {.length = 2});
  EXPECT_FALSE(guesses_depth(plain));
  EXPECT_TRUE(guesses_depth(guessed(plain)));
  WalkTrack depth_sensor = plain;
  for (SensorFrame& frame : depth_sensor.frames) {
    for (Joint& joint : frame.bodies[0].skeleton.joints)
      joint.covariance = Covariance(Eigen::Matrix3d(1e-4 * Eigen::Matrix3d::Identity()));
  }
  EXPECT_FALSE(guesses_depth(depth_sensor));
}

TEST(GuessedDepth, ChangesTheConfigurationOnlyIfNoSensorMeasuresDepth) {
  std::vector<WalkTrack> walk = cameras();
  EXPECT_GT(suited_to(walk, {}).along_ratio, RegistrationConfig{}.along_ratio);
  EXPECT_EQ(suited_to(walk, {}).joints, JointChoice::All);
  walk.push_back(watch(9, ring_place(0.3), {.length = 2}));
  EXPECT_EQ(suited_to(walk, {}), RegistrationConfig{});
  EXPECT_EQ(suited_to({}, {}), RegistrationConfig{});
}

/// Guessed depths fit worse, people are farther away, and places are less certain.
TEST(GuessedDepth, AllowsMoreAndNeverLessThanWasConfigured) {
  using Limit = double RegistrationConfig::*;
  const std::vector<WalkTrack> walk{
      guessed(watch(0, ring_place(0.0), {.length = 1, .noise = 0.0}))};
  for (const Limit limit : {&RegistrationConfig::max_edge_rms, &RegistrationConfig::max_speed,
                            &RegistrationConfig::max_distance, &RegistrationConfig::max_position}) {
    RegistrationConfig config;
    EXPECT_GT(suited_to(walk, config).*limit, 1.5 * config.*limit);
    config.*limit = 100.0;
    EXPECT_EQ(suited_to(walk, config).*limit, 100.0);
  }
}

TEST(CommonScale, OfAKnownDistanceIsExact) {
  RegistrationConfig config;
  config.known_distances = {{sensor(2), sensor(0), true_distance(0, 2)}};
  const Registration found = with_scale(exact(), cameras(), config);
  EXPECT_EQ(found.verdict, Verdict::Good);
  for (int i = 0; i < kCameras; ++i) {
    const Extrinsics& place = found.sensors.at(sensor(i));
    EXPECT_NEAR(place.scale, kTrueScale, 1e-6);
    EXPECT_LT(difference(place.world_from_sensor, ring_place(1.4 * i)).position, 1e-6);
  }
}

/// All places with nothing but one common factor of 5 % in their errors.
Registration of_one_factor() {
  Registration found = exact();
  JointCovariance together{{}, Eigen::MatrixXd::Zero(6 * kCameras, 6 * kCameras)};
  Eigen::VectorXd growth = Eigen::VectorXd::Zero(6 * kCameras);
  const Eigen::Vector3d master = found.sensors.at(found.master).world_from_sensor.translation();
  for (auto& [id, place] : found.sensors) {
    const auto at = static_cast<Eigen::Index>(6 * together.sensors.size() + 3);
    growth.segment<3>(at) = 0.05 * (place.world_from_sensor.translation() - master);
    place.covariance.bottomRightCorner<3, 3>() =
        growth.segment<3>(at) * growth.segment<3>(at).transpose();
    together.sensors.push_back(id);
  }
  together.matrix = growth * growth.transpose();
  found.together = together;
  return found;
}

TEST(CommonScale, OfAKnownDistanceLeavesNoCommonFactorInTheCovariances) {
  RegistrationConfig config;
  config.known_distances = {{sensor(2), sensor(0), true_distance(0, 2)}};
  const Registration found = with_scale(of_one_factor(), cameras(), config);
  EXPECT_FALSE(found.together);
  for (int i = 1; i < kCameras; ++i) {
    const Eigen::Matrix3d covariance =
        found.sensors.at(sensor(i)).covariance.bottomRightCorner<3, 3>();
    const double sigma = std::sqrt(covariance.trace());
    EXPECT_NEAR(sigma, 0.005 * true_distance(0, i), 0.0002 * true_distance(0, i)) << i;
  }
  config.known_distances.clear();
  const Registration open = with_scale(of_one_factor(), cameras(), config);
  EXPECT_GT(std::sqrt(open.sensors.at(sensor(2)).covariance.bottomRightCorner<3, 3>().trace()),
            0.05 * distance(exact(), 0, 2))
      << "without a length the factor stays in";
}

TEST(CommonScale, PlacesOfCamerasAreJudgedWhenItIsKnown) {
  RegistrationConfig config;
  config.cameras_alone = true;
  config.good_position = 0.15;
  config.known_distances = {{sensor(2), sensor(0), true_distance(0, 2)}};
  EXPECT_EQ(with_scale(of_one_factor(), cameras(), config).verdict, Verdict::Good);
  Registration wide = of_one_factor();
  wide.together->matrix.diagonal()[6 * 1 + 3] += 0.2 * 0.2;  // x of the second camera
  const Registration found = with_scale(wide, cameras(), config);
  EXPECT_EQ(found.verdict, Verdict::Provisional);
  EXPECT_THAT(found.reasons, testing::ElementsAre(HasSubstr("s1 is placed only to within")));
  EXPECT_EQ(found.verdicts.at(sensor(1)).verdict, Verdict::Provisional);
  EXPECT_EQ(found.verdicts.at(sensor(2)).verdict, Verdict::Good);
}

TEST(CommonScale, OfAStatureComesFromLegsAndTrunk) {
  RegistrationConfig config;
  config.stature = kStature;
  const Registration found = with_scale(exact(), cameras(), suited_to(cameras(), config));
  EXPECT_NEAR(found.sensors.at(sensor(1)).scale, kTrueScale, 2e-3);
  EXPECT_EQ(found.verdict, Verdict::Provisional);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("good to 8 % only")));
}

TEST(CommonScale, IsUnknownWithoutALengthAndTheCovarianceSaysSo) {
  const Registration before = exact();
  const Registration found = with_scale(before, cameras(), {});
  EXPECT_EQ(found.verdict, Verdict::Provisional);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("scale unknown")));
  for (const auto& [id, place] : found.sensors) {
    EXPECT_EQ(place.scale, 1.0);
    EXPECT_EQ(found.verdicts.at(id).verdict, Verdict::Provisional);
    const Eigen::Vector3d t = before.sensors.at(id).world_from_sensor.translation();
    const Eigen::Matrix3d expected = 0.06 * 0.06 * t * t.transpose();
    EXPECT_TRUE((place.covariance.bottomRightCorner<3, 3>().isApprox(expected, 1e-9)));
    EXPECT_TRUE((place.covariance.topRows<3>().isZero(0.0)));
  }
}

TEST(CommonScale, OfDepthSensorsIsNeverTouched) {
  std::vector<WalkTrack> walk = cameras();
  walk[1] = watch(1, ring_place(1.4), {.length = 6, .noise = 0.0});
  RegistrationConfig config;
  config.known_distances = {{sensor(0), sensor(1), 2.0 * distance(exact(), 0, 1)}};
  const Registration found = with_scale(exact(), walk, config);
  EXPECT_EQ(found.sensors.at(sensor(0)).scale, 1.0);
  EXPECT_EQ(distance(found, 0, 1), distance(exact(), 0, 1));
  EXPECT_TRUE(found.reasons.empty());
}

TEST(CommonScale, RefusesALengthThatCannotBe) {
  RegistrationConfig config;
  config.known_distances = {{sensor(0), sensor(1), 30.0}};
  const Registration found = with_scale(exact(), cameras(), config);
  EXPECT_THAT(found.reasons, Contains(HasSubstr("s0 and s1 cannot be 30.00 m apart")));
  EXPECT_THAT(found.reasons, Contains(HasSubstr("scale unknown")));
  EXPECT_EQ(found.sensors.at(sensor(0)).scale, 1.0);
}

TEST(CommonScale, TellsOfALengthThatContradictsThePersonsSize) {
  RegistrationConfig config;
  const double seen = distance(exact(), 0, 2);
  config.known_distances = {{sensor(0), sensor(2), 1.14 * seen}};
  EXPECT_TRUE(with_scale(exact(), cameras(), config).reasons.empty());
  for (const double factor : {1.27, 1.0 / 1.27}) {
    config.known_distances = {{sensor(0), sensor(2), factor * seen}};
    const Registration found = with_scale(exact(), cameras(), config);
    EXPECT_THAT(
        found.reasons,
        Contains(HasSubstr(fmt::format("s0 and s2: {:.2f} m given, {:.2f} m by the person's size",
                                       factor * seen, seen))));
    EXPECT_EQ(found.verdict, Verdict::Good) << "the length may be right";
    EXPECT_NEAR(found.sensors.at(sensor(1)).scale, factor, 1e-6) << "and is used";
  }
}

TEST(CommonScale, IsPartOfASolveByCamerasAlone) {
  RegistrationConfig config;
  config.known_distances = {{sensor(0), sensor(2), true_distance(0, 2)}};
  const Registration found = solve(cameras(), kWalkStart, config);
  ASSERT_EQ(found.sensors.size(), static_cast<std::size_t>(kCameras));
  EXPECT_NEAR(found.sensors.at(sensor(3)).scale, kTrueScale, 1e-3);
  for (int i = 1; i < kCameras; ++i) EXPECT_NEAR(distance(found, 0, i), true_distance(0, i), mm(5));
}

}  // namespace
}  // namespace chorus::registration
