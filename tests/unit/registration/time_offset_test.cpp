// Unknown clocks are found from the walk, or refused where the walk does not determine them.
#include "fusion-server/registration/time_offset.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/time/clock_estimate.h"
#include "fusion-server/registration/offset_profile.h"
#include "fusion-server/registration/overruled_clocks.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

using std::chrono::milliseconds;

WalkTrack off_by(WalkTrack track, Duration offset, double sigma) {
  for (SensorFrame& frame : track.frames) {
    move_in_time(frame, offset);
    frame.clock_sigma = sigma;
  }
  return track;
}

/// Sensors on a ring, 40 deg apart; the stamps of number i are ahead by offsets[i].
std::vector<WalkTrack> ring(const std::vector<Duration>& offsets, const WalkSpec& spec = {},
                            double sigma = kUnknownClock) {
  std::vector<WalkTrack> walk;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    walk.push_back(off_by(watch(number, ring_place(deg(40.0 * number)), spec), offsets[i], sigma));
  }
  return walk;
}

Eigen::Vector2d circle(double t) { return {1.2 * std::sin(0.75 * t), 1.2 * std::cos(0.75 * t)}; }

/// Largest error that is accepted: more than the stated sigma of about 3 ms, because the white
/// noise of these walks, 10 mm, is more than the estimator expects.
constexpr double kNear = 10.0;  // [ms]

double milliseconds_of(Duration duration) { return 1e3 * seconds(duration); }

TEST(WalkClocks, OfASensorThatContradictsTheOthersAreNotBelieved) {
  auto walk = ring({Duration{0}, milliseconds(20), milliseconds(-30)});
  for (SensorFrame& frame : walk[2].frames) {  // it follows somebody who stands still and turns
    frame.bodies = walk[0].frames.front().bodies;
    for (BodyFrame& body : frame.bodies) body.captured = frame.captured;
  }
  const Registration found = solve(walk, kWalkStart, {});
  ASSERT_TRUE(found.sensors.contains(sensor(2)));
  ASSERT_FALSE(found.sensors.contains(sensor(3)));
  EXPECT_TRUE(found.clocks.contains(sensor(2)));
  EXPECT_FALSE(found.clocks.contains(sensor(3)));
}

TEST(WalkClocks, ThatAreNotInStepAsStatedAreSearchedBeforeAnybodyIsRefused) {
  const auto walk =
      ring({Duration{0}, milliseconds(400), milliseconds(-350), milliseconds(150)}, {}, 0.0);
  const Registration found = solve(walk, kWalkStart, {});
  EXPECT_EQ(found.sensors.size(), 4u);
  ASSERT_TRUE(found.clocks.contains(sensor(2)) && found.clocks.contains(sensor(3)));
  const auto added = [&](int number) {
    return milliseconds_of(found.clocks.at(sensor(number)).added);
  };
  EXPECT_NEAR(added(2) - added(3), -750.0, kNear);
  EXPECT_TRUE(claims_overruled(found));
  EXPECT_NE(std::ranges::find_if(found.reasons,
                                 [](const std::string& reason) {
                                   return reason.find("not in step as stated") != std::string::npos;
                                 }),
            found.reasons.end());
}

TEST(WalkClocks, InStepAreNotSearchedBecauseOneSensorContradicts) {
  auto walk = ring({Duration{0}, Duration{0}, Duration{0}}, {}, 0.0);
  for (SensorFrame& frame : walk[2].frames) {  // it follows somebody who stands still and turns
    frame.bodies = walk[0].frames.front().bodies;
    for (BodyFrame& body : frame.bodies) body.captured = frame.captured;
  }
  const Registration found = solve(walk, kWalkStart, {});
  EXPECT_EQ(found.sensors.size(), 2u);
  EXPECT_TRUE(found.clocks.empty());
}

TEST(WalkClocks, AreTakenAsTheyAreWhenTheyAreKnown) {
  const auto clocks = clocks_of(ring({Duration{0}, milliseconds(212)}, {}, 0.001), {});
  EXPECT_TRUE(clocks.offsets.empty());
  EXPECT_TRUE(clocks.open.empty());
}

TEST(WalkClocks, AreToldByTheWalk) {
  const auto walk = ring({Duration{0}, milliseconds(212), milliseconds(-340)});
  const auto clocks = clocks_of(walk, {});
  EXPECT_TRUE(clocks.open.empty());
  ASSERT_EQ(clocks.offsets.size(), 3u);
  EXPECT_EQ(clocks.offsets.at(sensor(1)).added, Duration{0});
  EXPECT_NEAR(milliseconds_of(clocks.offsets.at(sensor(2)).added), -212, kNear);
  EXPECT_NEAR(milliseconds_of(clocks.offsets.at(sensor(3)).added), 340, kNear);
  EXPECT_LT(milliseconds_of(clocks.offsets.at(sensor(2)).sigma), kNear);
  EXPECT_GT(milliseconds_of(clocks.offsets.at(sensor(2)).sigma), 0.1);
}

TEST(WalkClocks, AreAgainstTheOneThatIsKnownBest) {
  auto walk = ring({milliseconds(100), Duration{0}});
  for (SensorFrame& frame : walk[1].frames) frame.clock_sigma = 0.001;
  const auto clocks = clocks_of(walk, {});
  EXPECT_EQ(clocks.offsets.at(sensor(2)).added, Duration{0});
  EXPECT_NEAR(milliseconds_of(clocks.offsets.at(sensor(1)).added), -100, kNear);
}

TEST(WalkClocks, OfACircleAreOpen) {
  WalkSpec spec;
  spec.path = circle;
  spec.noise = 0.02;
  const auto clocks = clocks_of(ring({Duration{0}, milliseconds(212)}, spec), {});
  ASSERT_EQ(clocks.open.size(), 1u);
  EXPECT_EQ(clocks.open.begin()->second.message,
            "walk straight once: the clocks of sensors s1 and s2 cannot be told from a circle or "
            "from standing");
}

/// s1 and s2 share only a circle; s3 shares other walks with both, so their clocks are known
/// through s3.
TEST(WalkClocks, OfAPairAreToldByWayOfOthers) {
  WalkSpec spec;
  spec.length = 40;
  spec.noise = 0.02;
  spec.path = [](double t) {
    if (t < 10 || t >= 30) return wander(t);
    return circle(t);
  };
  auto walk = ring({Duration{0}, milliseconds(212), milliseconds(-100)}, spec);
  const auto cut = [](WalkTrack& track, double from, double to) {
    const Timestamp begin = track.frames.front().captured;
    std::erase_if(track.frames, [&](const SensorFrame& frame) {
      const double t = seconds(frame.captured - begin);
      return t >= from && t < to;
    });
  };
  cut(walk[0], 30, 41);
  cut(walk[1], 0, 10);
  const auto clocks = clocks_of(walk, {});
  EXPECT_TRUE(clocks.open.empty());
  EXPECT_NEAR(milliseconds_of(clocks.offsets.at(sensor(2)).added), -212, 15);
}

/// The stamps are ahead of the time of receipt, as those of a camera may be.
TEST(WalkClocks, OfAFrameOrTwoHaveALeastAgeToo) {
  for (const std::size_t frames : {1U, 2U, 3U}) {
    auto walk = ring({Duration{0}, Duration{0}}, {.length = 1});
    walk[1].frames.resize(frames);
    Duration age = milliseconds(-40);
    for (SensorFrame& frame : walk[1].frames) {
      frame.received = frame.captured + age;
      age += milliseconds(5);
    }
    EXPECT_EQ(clocks_of(walk, {}).offsets.at(sensor(2)).least_age, milliseconds(-40)) << frames;
  }
}

TEST(BringInStep, MovesFramesAndBodies) {
  auto walk = ring({Duration{0}, milliseconds(50)});
  const Timestamp before = walk[1].frames[0].captured;
  WalkClocks clocks;
  clocks.offsets[sensor(2)].added = milliseconds(-50);
  bring_in_step(walk, clocks);
  EXPECT_EQ(walk[1].frames[0].captured, before - milliseconds(50));
  EXPECT_EQ(walk[1].frames[0].bodies[0].captured, before - milliseconds(50));
}

TEST(Solve, WithUnknownClocksFindsPlacesAndClocks) {
  const auto walk = ring({Duration{0}, milliseconds(212)});
  const Registration found = solve(walk, kWalkStart, {});
  ASSERT_EQ(found.sensors.size(), 2u);
  const auto& master = found.sensors.at(found.master).world_from_sensor;
  const auto& client =
      found.sensors.at(sensor(found.master == sensor(1) ? 2 : 1)).world_from_sensor;
  const double turn =
      angular_distance(Eigen::Quaterniond(master.linear()), Eigen::Quaterniond(client.linear()));
  EXPECT_NEAR((master.translation() - client.translation()).norm(), 2 * 3.0 * std::sin(deg(20)),
              0.03);
  EXPECT_NEAR(turn, deg(40), deg(3));
  EXPECT_NEAR(milliseconds_of(found.clocks.at(sensor(2)).added), -212, kNear);
}

TEST(Solve, RefusesAPairWhoseClocksAreOpenByName) {
  WalkSpec spec;
  spec.path = circle;
  spec.noise = 0.02;
  const Registration found = solve(ring({Duration{0}, milliseconds(212)}, spec), kWalkStart, {});
  EXPECT_EQ(found.verdict, Verdict::Refused);
  ASSERT_FALSE(found.reasons.empty());
  EXPECT_NE(found.reasons[0].find("walk straight once"), std::string::npos) << found.reasons[0];
}

TEST(OffsetProfile, OfSensorsThatSawNothingTogetherIsNone) {
  const WalkSpec spec;
  const Walker first = offset_walker(watch(1, ring_place(0), spec), {});
  const Walker late =
      offset_walker(off_by(watch(2, ring_place(deg(40)), spec), std::chrono::hours(1), 0.5), {});
  EXPECT_FALSE(OffsetProfile(first, late, {}, 1.1).best());
  EXPECT_FALSE(OffsetProfile(first, Walker{}, {}, 1.1).best());
}

/// Two cells of a hall share a passage, which is a tenth of what each of them sees.
TEST(OffsetProfile, OfSensorsThatShareAPassageOnlyIsFoundFromTheFramesAroundIt) {
  WalkSpec spec;
  spec.length = 180.0;
  WalkTrack passing = watch(1, ring_place(0), spec);
  std::erase_if(passing.frames, [](const SensorFrame& frame) {
    return std::fmod(seconds(frame.captured - kWalkStart), 20.0) > 2.0;
  });
  const Walker first = offset_walker(passing, {});
  const Walker second =
      offset_walker(off_by(watch(2, ring_place(deg(60)), spec), milliseconds(150), 0.5), {});
  const OffsetProfile profile(first, second, {}, 1.1);
  const auto best = profile.best();
  ASSERT_TRUE(best);
  EXPECT_NEAR(best->offset, -0.150, 0.020);
  EXPECT_LT(best->sigma, 0.050);
  EXPECT_TRUE(profile.place_at(best->offset));
}

TEST(OffsetProfile, WithoutFloorsFindsTheOffsetToo) {
  WalkSpec spec;
  spec.floor_in_world.reset();
  const Walker first = offset_walker(watch(1, ring_place(0), spec), {});
  const Walker second =
      offset_walker(off_by(watch(2, ring_place(deg(60)), spec), milliseconds(150), 0.5), {});
  const auto best = OffsetProfile(first, second, {}, 1.1).best();
  ASSERT_TRUE(best);
  EXPECT_NEAR(best->offset, -0.150, 0.005);
}

}  // namespace
}  // namespace chorus::registration
