#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fusion-server/registration/pair_registration.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::vector<WalkTrack> ring(int count, const WalkSpec& spec) {
  std::vector<WalkTrack> walk;
  for (int i = 0; i < count; ++i) {
    walk.push_back(watch(i, ring_place(2 * std::numbers::pi * i / count), spec));
  }
  return walk;
}

/// Error against the truth once both are expressed relative to the master.
PlaceError error_of(const Registration& registration, int number, int count) {
  const int master = std::stoi(registration.master.str().substr(1));
  const auto true_place = [&](int i) { return ring_place(2 * std::numbers::pi * i / count); };
  const auto found = [&](int i) { return registration.sensors.at(sensor(i)).world_from_sensor; };
  return difference(found(master).inverse() * found(number),
                    true_place(master).inverse() * true_place(number));
}

/// Solved once for all tests that look at a long walk: a solve takes seconds in a debug build.
const Registration& four_after_twenty_seconds() {
  static const Registration kSolved = solve(ring(4, {.length = 20}), kWalkStart, {});
  return kSolved;
}

TEST(Solve, FourSensorsInARingAfterTwentySeconds) {
  const Registration& registration = four_after_twenty_seconds();
  EXPECT_EQ(registration.verdict, Verdict::Good) << testing::PrintToString(registration.reasons);
  EXPECT_TRUE(registration.reasons.empty());
  ASSERT_EQ(registration.sensors.size(), 4u);
  EXPECT_EQ(registration.edges.size(), 6u);  // N (N - 1) / 2
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(error_of(registration, i, 4).position, mm(10));
    EXPECT_LT(error_of(registration, i, 4).angle, deg(0.3));
    const Extrinsics& place = registration.sensors.at(sensor(i));
    EXPECT_EQ(place.chain.front(), registration.master);
    EXPECT_EQ(place.chain.back(), sensor(i));
    EXPECT_NEAR(place.world_from_sensor.translation().y(), 1.8, mm(10));
  }
}

TEST(Solve, AWalkOfTwentySecondsIsOne) {
  // The last frame is taken before the twenty seconds are over.
  EXPECT_THAT(four_after_twenty_seconds().reasons,
              ::testing::Not(Contains(HasSubstr("lasted only"))));
}

TEST(Solve, AnotherEstimatorOfPairsTakesThePlaceOfOurs) {
  std::size_t asked = 0;
  const PairEstimator never = [&](const Walker& target, const Walker& source) {
    ++asked;
    return Result<PairwiseRegistration>(
        fail(ErrorCode::Conflict, "test", target.trail.sensor.str() + source.trail.sensor.str()));
  };
  const Registration registration = solve_with(never, ring(3, {.length = 5}), kWalkStart, {});
  EXPECT_EQ(asked, 3u);
  EXPECT_EQ(registration.verdict, Verdict::Refused);
}

TEST(Solve, TheWorldIsUnderTheMasterAndLevelOnTheCommonFloor) {
  RegistrationConfig config;
  config.master = sensor(2);
  const Registration registration = solve(ring(3, {.length = 6}), kWalkStart, config);
  EXPECT_EQ(registration.master, sensor(2));
  const Eigen::Isometry3d& world_from_master = registration.sensors.at(sensor(2)).world_from_sensor;
  EXPECT_LT((world_from_master.translation() - Eigen::Vector3d(0, 1.8, 0)).norm(), 5e-3);
  const Eigen::Vector3d view = world_from_master.linear() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(view.x(), 0.0, 1e-3);
  EXPECT_NEAR(view.z(), std::cos(deg(15)), 1e-3);
  EXPECT_EQ(registration.sensors.at(sensor(2)).error, 0.0);
}

/// Four sensors side by side along a corridor, 1.2 m apart, each of which sees up to `range`; the
/// person walks along the corridor.
std::vector<WalkTrack> corridor(double range) {
  const WalkSpec spec{.path =
                          [](double t) {
                            return Eigen::Vector2d(1.8 + 2.6 * std::sin(0.25 * t),
                                                   2.2 + 0.4 * std::sin(0.9 * t));
                          },
                      .length = 60,
                      .range = range};
  std::vector<WalkTrack> walk;
  for (int i = 0; i < 4; ++i) walk.push_back(watch(i, place(1.2 * i, 0, 0), spec));
  return walk;
}

TEST(Solve, ChainsSensorsThatDoNotOverlap) {
  const Registration registration = solve(corridor(2.4), kWalkStart, {.master = sensor(0)});
  ASSERT_EQ(registration.sensors.size(), 4u) << testing::PrintToString(registration.reasons);
  const Extrinsics& last = registration.sensors.at(sensor(3));
  EXPECT_GT(last.chain.size(), 2u);
  const Eigen::Isometry3d expected = place(0, 0, 0).inverse() * place(3.6, 0, 0);
  const Eigen::Isometry3d found =
      registration.sensors.at(sensor(0)).world_from_sensor.inverse() * last.world_from_sensor;
  EXPECT_LT(difference(found, expected).position, mm(30));
  const auto position_trace = [&](int i) {
    return registration.sensors.at(sensor(i)).covariance.bottomRightCorner<3, 3>().trace();
  };
  EXPECT_GT(position_trace(3), position_trace(1));  // uncertainty grows along the chain
}

TEST(Solve, NamesTheSensorsThatNeverSawThePersonTogether) {
  std::vector<WalkTrack> walk = ring(2, {});
  for (SensorFrame& frame : walk[1].frames) frame.captured += std::chrono::hours(1);
  const Registration registration = solve(walk, kWalkStart, {});
  EXPECT_EQ(registration.verdict, Verdict::Refused);
  EXPECT_THAT(registration.reasons, Contains("sensors s0 and s1 never saw the person together"));
  EXPECT_EQ(registration.sensors.size(), 1u);
}

TEST(Solve, AnUnlinkedSensorIsRefusedAloneAndLeavesTheOthersGood) {
  std::vector<WalkTrack> walk = ring(3, {.length = 20});
  for (SensorFrame& frame : walk[2].frames) frame.captured += std::chrono::hours(1);
  const Registration registration = solve(walk, kWalkStart, {});
  EXPECT_EQ(registration.verdict, Verdict::Good);
  EXPECT_EQ(registration.sensors.size(), 2u);
  const std::string reason = "sensor s2 never saw the person together with any of s0, s1";
  EXPECT_THAT(registration.reasons, Contains(reason));
  ASSERT_EQ(registration.verdicts.size(), 3u);
  EXPECT_EQ(registration.verdicts.at(sensor(2)).verdict, Verdict::Refused);
  EXPECT_EQ(registration.verdicts.at(sensor(2)).reasons, std::vector{reason});
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(registration.verdicts.at(sensor(i)).verdict, Verdict::Good);
    EXPECT_TRUE(registration.verdicts.at(sensor(i)).reasons.empty());
  }
}

TEST(Solve, ShortWalksStayProvisionalAndSaySo) {
  const Registration registration = solve(ring(3, {.length = 8}), kWalkStart, {});
  EXPECT_EQ(registration.verdict, Verdict::Provisional);
  EXPECT_THAT(registration.reasons, Contains(HasSubstr("lasted only 8 s")));
  EXPECT_EQ(registration.sensors.size(), 3u);
}

TEST(Solve, OneSensorIsItsOwnWorld) {
  const Registration registration = solve(ring(1, {}), kWalkStart, {});
  EXPECT_EQ(registration.verdict, Verdict::Good) << testing::PrintToString(registration.reasons);
  ASSERT_EQ(registration.sensors.size(), 1u);
  const Extrinsics& only = registration.sensors.at(sensor(0));
  EXPECT_EQ(only.chain, std::vector{sensor(0)});
  EXPECT_NEAR(only.world_from_sensor.translation().y(), 1.8, 1e-6);
}

TEST(Solve, SaysWhenItWasSolved) {
  for (const Timestamp now : {kWalkStart, kWalkStart + std::chrono::minutes(3)})
    EXPECT_EQ(solve(ring(1, {.length = 1}), now, {}).solved, now);
}

TEST(Solve, NothingSeenIsNoVerdict) {
  EXPECT_EQ(solve({}, kWalkStart, {}).verdict, Verdict::None);
  const Registration silent = solve({{sensor(1), {}}, {sensor(2), {}}}, kWalkStart, {});
  EXPECT_EQ(silent.verdict, Verdict::None);
  EXPECT_THAT(silent.reasons, Contains("no sensor has delivered a frame yet"));
}

TEST(Solve, ImplausibleFloorsAreNamedAndNotUsed) {
  const FloorPlane table{Eigen::Vector3d::UnitY(), -0.8};  // 0.8 m above the real floor
  std::vector<WalkTrack> walk = ring(2, {.length = 20});
  walk[1] = watch(1, ring_place(std::numbers::pi), {.length = 20, .floor_in_world = table});
  const Registration registration = solve(walk, kWalkStart, {.master = sensor(0)});
  EXPECT_THAT(registration.reasons, Contains(HasSubstr("above the person's feet")));
  EXPECT_EQ(registration.verdict, Verdict::Provisional);
  EXPECT_EQ(registration.verdicts.at(sensor(0)).verdict, Verdict::Good);
  EXPECT_EQ(registration.verdicts.at(sensor(1)).verdict, Verdict::Provisional);
  EXPECT_LT(error_of(registration, 1, 2).position, mm(20));
}

TEST(Solve, WithoutAnyFloorTheUprightBodyLevelsTheWorld) {
  const Registration registration =
      solve(ring(3, {.length = 8, .floor_in_world = std::nullopt}), kWalkStart, {});
  EXPECT_EQ(registration.verdict, Verdict::Provisional);
  EXPECT_THAT(registration.reasons, Contains(HasSubstr("guessed from the upright body")));
  for (const auto& [id, found] : registration.sensors) {
    EXPECT_NEAR(found.world_from_sensor.translation().y(), 1.8, 0.05) << id.str();
    const double pitch = -std::asin(found.world_from_sensor.linear()(1, 2));
    EXPECT_NEAR(pitch, deg(15), deg(1)) << id.str();
  }
}

TEST(Solve, AnUnknownMasterIsReplacedAndNamed) {
  const Registration registration =
      solve(ring(2, {.length = 5}), kWalkStart, {.master = sensor(9)});
  EXPECT_THAT(registration.reasons, Contains(HasSubstr("master s9")));
  EXPECT_EQ(registration.sensors.size(), 2u);
}

TEST(Solve, TheOrderOfTheTracksDoesNotMatterAndASecondTrackOfASensorIsIgnored) {
  const auto walk = ring(3, {.length = 6});
  const Registration first = solve(walk, kWalkStart, {});
  std::vector<WalkTrack> mixed{walk[2], walk[0], walk[1], walk[0]};
  mixed.back().frames.clear();
  const Registration second = solve(mixed, kWalkStart, {});
  EXPECT_EQ(first.master, second.master);
  ASSERT_EQ(second.sensors.size(), 3u);
  for (const auto& [id, place] : first.sensors) {
    EXPECT_EQ(place.world_from_sensor.matrix(), second.sensors.at(id).world_from_sensor.matrix());
  }
}

/// Sensors whose depth is inaccurate, like single cameras, determine together what no chain of
/// pairs does.
TEST(Solve, FromThreeSensorsOnAllAreAdjustedTogether) {
  RegistrationConfig config;
  config.along_ratio = 8.0;
  config.max_edge_rms = 0.6;
  double chained = 0.0;
  double adjusted = 0.0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    std::vector<WalkTrack> walk = ring(3, {.length = 8, .noise = 0.004, .seed = seed});
    for (WalkTrack& track : walk) track = with_depth_error(std::move(track), 0.15, 10 * seed);
    config.adjust_together = false;
    const Registration alone = solve(walk, kWalkStart, config);
    config.adjust_together = true;
    const Registration together = solve(walk, kWalkStart, config);
    ASSERT_EQ(together.sensors.size(), 3u);
    for (int i = 0; i < 3; ++i) {
      chained += error_of(alone, i, 3).position;
      adjusted += error_of(together, i, 3).position;
    }
  }
  EXPECT_LT(adjusted, 0.9 * chained);
}

/// A person who walks elsewhere at the same time.
Eigen::Vector2d stroll(double t) {
  return {0.9 * std::cos(0.37 * t) - 0.3 * std::sin(1.7 * t), 0.8 * std::sin(0.83 * t + 2.0)};
}

WalkTrack mirrored(WalkTrack track) {
  for (SensorFrame& frame : track.frames) {
    for (Joint& joint : frame.bodies[0].skeleton.joints) joint.position.x() *= -1.0;
  }
  return track;
}

void expect_only_refused(const Registration& registration, int odd, const std::string& reason) {
  EXPECT_FALSE(registration.sensors.contains(sensor(odd)));
  EXPECT_EQ(registration.verdicts.at(sensor(odd)).verdict, Verdict::Refused);
  EXPECT_THAT(registration.verdicts.at(sensor(odd)).reasons, Contains(HasSubstr(reason)));
  for (int i = 0; i < 4; ++i) {
    if (i == odd) continue;
    ASSERT_TRUE(registration.sensors.contains(sensor(i))) << i;
    EXPECT_LT(error_of(registration, i, 4).position, mm(20)) << i;
  }
}

/// Long enough to tell who contradicts the others.
const WalkSpec kShort{.length = 8};

TEST(Solve, WhoFollowedSomebodyElseIsRefusedByNameAndTheRestStands) {
  std::vector<WalkTrack> walk = ring(4, kShort);
  walk[3] = watch(3, ring_place(1.5 * std::numbers::pi), {.path = stroll, .length = kShort.length});
  expect_only_refused(solve(walk, kWalkStart, {}), 3, "sensor s3 contradicts s0, s1, s2");
}

TEST(Solve, AMirroredOneIsRefusedByNameEvenAsTheWantedMaster) {
  std::vector<WalkTrack> walk = ring(4, kShort);
  walk[1] = mirrored(walk[1]);
  RegistrationConfig config;
  config.master = sensor(1);
  expect_only_refused(solve(walk, kWalkStart, config), 1, "sensor s1 contradicts s0, s2, s3");
}

TEST(Solve, OneWhoseClockIsWrongIsRefusedByName) {
  std::vector<WalkTrack> walk = ring(4, {.length = 12});
  for (SensorFrame& frame : walk[2].frames) frame.captured += std::chrono::seconds(3);
  expect_only_refused(solve(walk, kWalkStart, {}), 2, "sensor s2 contradicts s0, s1, s3");
}

TEST(Solve, OneThatRepeatsAnotherIsRefusedByName) {
  std::vector<WalkTrack> walk = ring(4, kShort);
  walk[3].frames = walk[1].frames;
  expect_only_refused(solve(walk, kWalkStart, {}), 3, "sensor s3 reports exactly what s1 reports");
}

TEST(Solve, APlaceThatNobodyCanVouchForIsRefusedWithWhereToWalk) {
  RegistrationConfig strict;
  strict.max_position = mm(5);
  const Registration refused = solve(ring(2, {.length = 8}), kWalkStart, strict);
  EXPECT_EQ(refused.verdict, Verdict::Refused);
  EXPECT_THAT(refused.reasons, Contains(HasSubstr("of 0.01 m allowed: walk where s")));
  EXPECT_EQ(solve(ring(2, {.length = 8}), kWalkStart, {}).sensors.size(), 2u);
}

/// A star: only the edges of sensor 2 are accurate.
TEST(Solve, TheMasterIsWhoReachesMostWithTheLeastError) {
  const PairEstimator star = [](const Walker& target, const Walker& source) {
    PairwiseRegistration edge{target.trail.sensor, source.trail.sensor};
    edge.pairs = edge.inliers = 100;
    edge.spread = 1.0;
    edge.rms = 0.02;
    if (edge.target != sensor(2) && edge.source != sensor(2)) edge.rms = 0.30;
    return Result<PairwiseRegistration>(edge);
  };
  RegistrationConfig config;
  config.adjust_together = false;
  const auto walk = ring(4, {.length = 1});
  EXPECT_EQ(solve_with(star, walk, kWalkStart, config).master, sensor(2));
}

TEST(Solve, AHeadDownOrBuriedSensorIsRefusedAndNamed) {
  Eigen::Isometry3d wrong = Eigen::Isometry3d::Identity();
  const PairEstimator estimate = [&](const Walker& target, const Walker& source) {
    PairwiseRegistration edge{target.trail.sensor, source.trail.sensor};
    edge.pairs = edge.inliers = 100;
    edge.spread = 1.0;
    edge.target_from_source = wrong;
    return Result<PairwiseRegistration>(edge);
  };
  RegistrationConfig config;
  config.master = sensor(0);
  config.adjust_together = false;
  wrong.linear() = Eigen::AngleAxisd(deg(170), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  auto walk = ring(2, {.length = 1});  // with a floor of its own, sensor 1 would have a place
  for (SensorFrame& frame : walk[1].frames) frame.floor.reset();
  const Registration head_down = solve_with(estimate, walk, kWalkStart, config);
  EXPECT_THAT(head_down.reasons, Contains(HasSubstr("sensor s1 would see people head down")));
  EXPECT_FALSE(head_down.sensors.contains(sensor(1)));
  wrong.linear().setIdentity();
  wrong.translation().y() = -2.5;
  const Registration buried = solve_with(estimate, walk, kWalkStart, config);
  EXPECT_THAT(buried.reasons, Contains(HasSubstr("m below the floor")));
  wrong.translation().y() = -2.0;
  EXPECT_FALSE(solve_with(estimate, walk, kWalkStart, config).sensors.contains(sensor(1)));
  for (SensorFrame& frame : walk[0].frames) frame.floor.reset();
  EXPECT_TRUE(solve_with(estimate, walk, kWalkStart, config).sensors.contains(sensor(1)))
      << "a guessed floor refuses nobody for less than a metre";
}

TEST(Solve, EdgesThatFitBadlyMakeTheVerdictProvisional) {
  const auto walk = ring(2, {.length = 20, .noise = 0.06});
  const Registration registration = solve(walk, kWalkStart, {});
  EXPECT_EQ(registration.verdict, Verdict::Provisional);
  EXPECT_THAT(registration.reasons, Contains(HasSubstr("m rms along the walk; 0.080 m")));
}

TEST(Solve, SameWalkSameAnswer) {
  const auto walk = ring(3, {.length = 5});
  const Registration first = solve(walk, kWalkStart, {});
  const Registration second = solve(walk, kWalkStart, {});
  for (const auto& [id, place] : first.sensors) {
    EXPECT_EQ(place.world_from_sensor.matrix(), second.sensors.at(id).world_from_sensor.matrix());
  }
}

}  // namespace
}  // namespace chorus::registration
