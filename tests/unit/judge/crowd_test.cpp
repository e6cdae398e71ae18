#include "tests/judge/crowd.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace chorus::bench {
namespace {

Eigen::Vector2d neck_at(const synthetic::Person& person, double time) {
  const Eigen::Vector3d neck = person(from_seconds(time))[JointId::Neck].position;
  return {neck.x(), neck.z()};
}

/// Smallest distance between any two people during two minutes.
double least_distance(const std::vector<synthetic::Person>& people) {
  double least = std::numeric_limits<double>::infinity();
  for (double time = 0; time < 120; time += 0.1) {
    for (std::size_t a = 0; a < people.size(); ++a) {
      for (std::size_t b = a + 1; b < people.size(); ++b) {
        least = std::min(least, (neck_at(people[a], time) - neck_at(people[b], time)).norm());
      }
    }
  }
  return least;
}

TEST(CrossingPeople, PassEachOtherAtHalfAMetreAgainAndAgain) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto people = crossing_people(2, seed);
    ASSERT_EQ(people.size(), 2u);
    EXPECT_NEAR(least_distance(people), 0.5, 0.1) << seed;
    int passings = 0;
    bool near = false;
    for (double time = 0; time < 60; time += 0.05) {
      const bool now = (neck_at(people[0], time) - neck_at(people[1], time)).norm() < 0.7;
      passings += now && !near ? 1 : 0;
      near = now;
    }
    EXPECT_GE(passings, 6) << seed;
  }
}

TEST(CrossingPeople, OfSeveralPairsDoNotWalkThroughEachOther) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    EXPECT_EQ(crossing_people(6, seed).size(), 6u);
    EXPECT_GT(least_distance(crossing_people(4, seed)), 0.3) << seed;
    EXPECT_GT(least_distance(crossing_people(6, seed)), 0.3) << seed;
  }
}

TEST(CrossingPeople, PassAsCloselyAsAsked) {
  EXPECT_NEAR(least_distance(crossing_people(2, 1, 0.3)), 0.3, 0.1);
}

TEST(RelayedPeople, EnterWhereTheLastOneLeftAndNeverMeet) {
  const Timestamp begin = from_unix_ns(1'795'000'000'000'000'000);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto people = relayed_people(seed, begin);
    std::vector<Eigen::Vector2d> entered;
    std::vector<Eigen::Vector2d> left;
    for (double time = 0; time < 30; time += 0.01) {
      const double now = seconds(begin.time_since_epoch()) + time;
      int inside = 0;
      for (std::size_t i = 0; i < people.size(); ++i) {
        const Eigen::Vector2d place = neck_at(people[i], now);
        if (place.norm() > kOutside) continue;
        ++inside;
        if (entered.size() == i) entered.push_back(place);
        left.resize(entered.size());
        left[i] = place;
      }
      EXPECT_LE(inside, 1) << seed << " " << time;
    }
    ASSERT_EQ(entered.size(), 3u) << seed;
    EXPECT_LT((entered[1] - left[0]).norm(), 0.1) << seed;
    EXPECT_LT((entered[2] - left[1]).norm(), 0.1) << seed;
  }
}

TEST(Screen, HidesWhoCrossesBehindItFromEverySensor) {
  for (const Eigen::Isometry3d& place : places_behind_screen()) {
    const Eigen::Vector3d eye = place.translation();
    const Eigen::Vector3d neck(0, 1.4, 0);
    const double share = (screen().world_from_box.translation().x() - eye.x()) / -eye.x();
    const Eigen::Vector3d through = eye + share * (neck - eye);
    EXPECT_LT(std::abs(through.z()), screen().half.z());
    EXPECT_LT(through.y(), 2.0 * screen().half.y());
    EXPECT_GT((place.linear() * Eigen::Vector3d::UnitZ()).x(), 0.9);  // the sensor looks along +x
  }
}

TEST(CircledPerson, StandsInTheMiddleOfTheOthersWay) {
  const auto people = circled_person(1);
  ASSERT_EQ(people.size(), 2u);
  for (double time = 0; time < 20; time += 1) {
    EXPECT_LT(neck_at(people[0], time).norm(), 0.2);
    EXPECT_NEAR(neck_at(people[1], time).norm(), 0.8, 0.25);
  }
}

TEST(PeopleAtWork, KeepApart) {
  EXPECT_GT(least_distance(people_at_work(4, 1)), 0.3);
  EXPECT_GT(least_distance(people_at_work(6, 1)), 0.3);
}

TEST(PeopleAround, AreOppositeToEachOther) {
  EXPECT_GT(least_distance(people_around(1.5, 1)), 2.3);
}

const Timestamp kBegin = from_unix_ns(1'795'000'000'000'000'000);

/// Which people are in the room `time` seconds after the beginning.
std::vector<bool> inside_at(const std::vector<synthetic::Person>& people, double time) {
  std::vector<bool> inside;
  for (const auto& person : people)
    inside.push_back(neck_at(person, seconds(kBegin.time_since_epoch()) + time).norm() < kOutside);
  return inside;
}

TEST(ReturningPeople, GoOutAndComeBackAfterAMomentAndAfterTwentySeconds) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto people = returning_people(seed, kBegin);
    using Room = std::vector<bool>;
    EXPECT_EQ(inside_at(people, 0.0), (Room{true, true, true}));
    EXPECT_EQ(inside_at(people, 8.2), (Room{false, true, true}));
    EXPECT_EQ(inside_at(people, 10.1), (Room{true, true, true}));
    EXPECT_EQ(inside_at(people, 33.0), (Room{false, false, false}));
    EXPECT_EQ(inside_at(people, 35.0), (Room{false, true, false}));
    EXPECT_EQ(inside_at(people, 50.0), (Room{true, true, true}));
  }
}

TEST(BoothPeople, TakeTurnsBehindTheScreen) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto people = booth_people(seed, kBegin);
    auto before = inside_at(people, 0.0);
    EXPECT_EQ(before, (std::vector<bool>{true, false}));
    int left = 0;
    for (double time = 0; time < 60; time += 0.01) {
      const auto now = inside_at(people, time);
      EXPECT_FALSE(now[0] && now[1]) << seed << " " << time;
      for (std::size_t i = 0; i < 2; ++i) {
        if (now[i] == before[i]) continue;
        left += before[i] ? 1 : 0;
        const double there = seconds(kBegin.time_since_epoch()) + time - (now[i] ? 0.0 : 0.01);
        EXPECT_NEAR(neck_at(people[i], there).y(), 0.0, 0.1) << seed << " " << time;
      }
      before = now;
    }
    EXPECT_GE(left, 3) << seed;
  }
}

TEST(SideBySide, StandBesideEachOtherAndNeverMeet) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    EXPECT_GT(least_distance(side_by_side(seed)), 0.4) << seed;
  }
}

/// How far a point is outside a box; negative: inside.
double outside_of(const synthetic::Occluder& box, const Eigen::Vector3d& point) {
  return ((box.world_from_box.inverse() * point).cwiseAbs() - box.half).maxCoeff();
}

TEST(WorkerBesideCar, StandsClearOfItAndFacesIt) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const auto people = worker_beside_car(seed);
    ASSERT_EQ(people.size(), 1u);
    double nearest = std::numeric_limits<double>::infinity();
    for (double time = 0; time < 60; time += 0.1) {
      const Skeleton<WorldSpace> body = people[0](from_seconds(time));
      for (const Joint& joint : body.joints) {
        nearest = std::min(nearest, outside_of(car_body(), joint.position));
        EXPECT_GT(outside_of(pillar(), joint.position), 0.5) << seed << " " << time;
      }
      EXPECT_GT((body[JointId::ShoulderRight].position - body[JointId::ShoulderLeft].position).z(),
                0.2)
          << seed << " " << time;
    }
    EXPECT_GT(nearest, 0.0) << seed;
    EXPECT_LT(nearest, 0.2) << seed;
  }
}

}  // namespace
}  // namespace chorus::bench
