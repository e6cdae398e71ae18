#include "tests/judge/cold_start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::bench {
namespace {

using enum JointId;

constexpr Timestamp kColdBegin = from_unix_ns(1'795'000'000'000'000'000);

Skeleton<WorldSpace> body_at(const synthetic::Person& person, double time) {
  return person((kColdBegin + from_seconds(time)).time_since_epoch());
}

Eigen::Vector2d place_of(const Skeleton<WorldSpace>& body) {
  return {body[SpineBase].position.x(), body[SpineBase].position.z()};
}

/// The direction that the body faces, along the floor.
Eigen::Vector2d forward_of(const Skeleton<WorldSpace>& body) {
  const Eigen::Vector3d left = body[HipLeft].position - body[HipRight].position;
  return Eigen::Vector2d(-left.z(), left.x()).normalized();
}

synthetic::Person person_of(ColdStart start, std::uint64_t seed) {
  ColdScript script;
  script.start = start;
  script.seed = seed;
  script.begin = kColdBegin;
  return cold_starter(script);
}

constexpr ColdStart kAll[] = {ColdStart::Stand, ColdStart::Wave, ColdStart::Back, ColdStart::Enter};

TEST(ColdStart, MovesWithoutJumpsAndWithBonesOfOneLength) {
  for (const ColdStart start : kAll) {
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      const auto person = person_of(start, seed);
      auto before = body_at(person, 0.0);
      const double shank = (before[KneeLeft].position - before[AnkleLeft].position).norm();
      for (double time = 0.01; time < 12.0; time += 0.01) {
        const auto now = body_at(person, time);
        for (std::size_t i = 0; i < kJointCount; ++i) {
          const double step = (now.joints[i].position - before.joints[i].position).norm();
          ASSERT_LT(step, 0.06) << static_cast<int>(start) << " " << seed << " " << time << " "
                                << name_of(static_cast<JointId>(i));
        }
        ASSERT_NEAR((now[KneeLeft].position - now[AnkleLeft].position).norm(), shank, 1e-3);
        before = now;
      }
    }
  }
}

TEST(ColdStart, OfSomebodyWhoStandsOrWavesStaysInPlace) {
  for (const ColdStart start : {ColdStart::Stand, ColdStart::Wave}) {
    const auto person = person_of(start, 3);
    const Eigen::Vector2d place = place_of(body_at(person, 0));
    for (double time = 0; time < 3.9; time += 0.1) {
      EXPECT_LT((place_of(body_at(person, time)) - place).norm(), 0.02);
    }
  }
  double highest = 0;
  const auto waver = person_of(ColdStart::Wave, 3);
  for (double time = 0; time < 4; time += 0.1) {
    const auto body = body_at(waver, time);
    highest = std::max(highest, body[WristRight].position.y() - body[ShoulderRight].position.y());
  }
  EXPECT_GT(highest, 0.1);
}

TEST(ColdStart, OfSomebodyWhoWalksBackwardsLeadsAgainstWhereTheyFace) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto person = person_of(ColdStart::Back, seed);
    const auto first = body_at(person, 0.0);
    const Eigen::Vector2d way = place_of(body_at(person, 2.0)) - place_of(first);
    EXPECT_GT(way.norm(), 0.8);
    EXPECT_LT(way.normalized().dot(forward_of(first)), -0.9);
  }
}

TEST(ColdStart, OfSomebodyWhoEntersComesFromOutsideBetweenTwoSensors) {
  const synthetic::Ring ring;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const auto person = person_of(ColdStart::Enter, seed);
    EXPECT_GT(place_of(body_at(person, 0.0)).norm(), 3.7) << seed;
    double nearest = 10.0;
    for (double time = 0; time < 8; time += 0.05) {
      const auto body = body_at(person, time);
      for (const auto& place : ring_places(ring)) {
        const Eigen::Vector2d stand(place.translation().x(), place.translation().z());
        nearest = std::min(nearest, (place_of(body) - stand).norm());
      }
    }
    EXPECT_GT(nearest, 0.8) << seed;
    const auto walking = body_at(person, 1.0);
    const Eigen::Vector2d way = place_of(body_at(person, 1.5)) - place_of(walking);
    EXPECT_GT(way.normalized().dot(forward_of(walking)), 0.9) << "and looks where they go";
    EXPECT_LT(place_of(body_at(person, 8.0)).norm(), 1.8);
  }
}

}  // namespace
}  // namespace chorus::bench
