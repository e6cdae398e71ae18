#include "tests/judge/crowd.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"

namespace chorus::bench {
namespace {

using synthetic::PathKind;
using synthetic::WalkerScript;

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr double kCircling = 0.8;  // [m]
constexpr double kReach = 1.3;     // how far people who cross walk from the middle [m]
constexpr double kWorkRing = 1.0;  // radius on which the working places lie [m]
constexpr double kGap = 0.4;       // between people at work [m]
constexpr double kStint = 10.0;    // time that one person of a relay is in the room [s]
constexpr double kMinPause = 0.3, kMaxPause = 2.0;  // [s]
constexpr double kNever = 1e9;                      // [s]
constexpr double kBeside = 0.5;                     // from the middle, for two side by side [m]
constexpr double kFromCar = 1.05;  // of a worker from the middle of the car, 0.65 from its side [m]
constexpr double kBench = 0.2;     // between neighbouring stations of one person [m]
enum Purpose : std::uint64_t { kBuild = 701, kSpeed, kHour, kPause };

/// A walker of random build; the random speed is the same for all people of one `seed`.
WalkerScript script_of(std::uint64_t seed, std::size_t person, PathKind path) {
  constexpr double kSpread = 0.08;
  WalkerScript script;
  script.seed = seed + 100 * person;
  script.path = path;
  script.body_scale += synthetic::Draw{seed, kBuild, person}.uniform(-kSpread, kSpread);
  script.speed = synthetic::Draw{seed, kSpeed}.uniform(0.7, 1.1);
  return script;
}

/// How a walk is shifted to the side, turned about the middle and shifted in time.
struct Placing {
  double yaw = 0.0;    ///< [rad]
  double aside = 0.0;  ///< Shift along +x, before the turn [m]
  double delay = 0.0;  ///< Added to the time since 1970: the walk is ahead by this [s]
};

Skeleton<WorldSpace> turned(Skeleton<WorldSpace> body, const Eigen::Isometry3d& placed) {
  for (Joint& joint : body.joints) {
    joint.position = placed * joint.position;
    if (is_unit(joint.orientation)) {
      joint.orientation = Eigen::Quaterniond(placed.linear()) * joint.orientation;
    }
  }
  return body;
}

synthetic::Person placed(const WalkerScript& script, const Placing& placing) {
  return [walker = synthetic::Walker(script), placing](Duration since_epoch) {
    const Duration time = since_epoch + from_seconds(placing.delay);
    const Eigen::Isometry3d to_world(about_y(placing.yaw) *
                                     Eigen::Translation3d(placing.aside, 0, 0));
    return turned(walker.at(time), to_world);
  };
}

/// A stay in the room, in seconds from the beginning; `behind` is how long the walk has paused.
struct Stint {
  double enters = 0.0;
  double leaves = kNever;
  double behind = 0.0;
};

/// A person who is out of the room between their stints.
synthetic::Person in_stints(synthetic::Person walk, Timestamp begin, std::vector<Stint> stints) {
  return [walk = std::move(walk), begin, stints = std::move(stints)](Duration since_epoch) {
    const double time = seconds(Timestamp{since_epoch} - begin);
    for (const Stint& stint : stints) {
      if (time >= stint.enters && time < stint.leaves)
        return walk(since_epoch - from_seconds(stint.behind));
    }
    Skeleton<WorldSpace> body = walk(since_epoch);
    for (Joint& joint : body.joints) joint.position.x() += 2.0 * kOutside;
    return body;
  };
}

/// When a person who walks along z next passes the middle, from `time` on [s since 1970].
double next_middle(const synthetic::Person& walk, double time) {
  constexpr double kStep = 0.01;  // [s]
  const auto z_at = [&](double t) { return walk(from_seconds(t))[JointId::Neck].position.z(); };
  for (double before = z_at(time);; before = z_at(time)) {
    time += kStep;
    if (before * z_at(time) <= 0.0) return time;
  }
}

double heading_of_line(const WalkerScript& script) {
  const synthetic::Walker walker(script);
  const Eigen::Vector2d from = walker.path().at(Duration{0}).place;
  return std::atan2(-from.x(), -from.y());  // a line begins at its far end
}

}  // namespace

std::vector<synthetic::Person> crossing_people(std::size_t count, std::uint64_t seed,
                                               double passing) {
  std::vector<synthetic::Person> people;
  const std::size_t pairs = std::max<std::size_t>(1, count / 2);
  const double hour = synthetic::Draw{seed, kHour}.uniform(0.0, 10.0);
  for (std::size_t i = 0; i < 2 * pairs; ++i) {
    // Both people of a pair have the same walk.
    WalkerScript script = script_of(seed, i / 2, PathKind::Line);
    script.reach = kReach;
    const synthetic::Walker walker(script);
    const double loop = seconds(walker.path().loop());
    const auto pair = static_cast<double>(i / 2);
    const auto pair_count = static_cast<double>(pairs);
    Placing placing;
    placing.yaw = -heading_of_line(script) + std::numbers::pi * pair / pair_count +
                  (i % 2 == 0 ? 0.0 : std::numbers::pi);
    placing.delay = hour + 0.5 * loop * pair / pair_count;  // each pair meets at another time
    const Eigen::Vector3d left = about_y(heading_of_line(script)) * Eigen::Vector3d::UnitX();
    script.centre = 0.5 * passing * Eigen::Vector2d(left.x(), left.z());
    people.push_back(placed(script, placing));
  }
  return people;
}

std::vector<synthetic::Person> circled_person(std::uint64_t seed) {
  WalkerScript around = script_of(seed, 1, PathKind::Circle);
  around.reach = kCircling;
  return {placed(script_of(seed, 0, PathKind::Stand), {}), placed(around, {})};
}

std::vector<synthetic::Person> people_at_work(std::size_t count, std::uint64_t seed) {
  std::vector<synthetic::Person> people;
  const double first = synthetic::Draw{seed, kHour}.uniform(0.0, kFullTurn);
  const double between = 2.0 * kWorkRing * std::sin(0.5 * kFullTurn / static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    WalkerScript script = script_of(seed, i, PathKind::Random);
    script.reach = std::max(0.1, 0.5 * (between - kGap));
    const double angle = first + kFullTurn * static_cast<double>(i) / static_cast<double>(count);
    script.centre = kWorkRing * Eigen::Vector2d(std::sin(angle), std::cos(angle));
    people.push_back(placed(script, {}));
  }
  return people;
}

std::vector<synthetic::Person> people_around(double radius, std::uint64_t seed) {
  WalkerScript script = script_of(seed, 0, PathKind::Circle);
  script.reach = radius;
  Placing opposite;
  opposite.yaw = std::numbers::pi;
  return {placed(script, {}), placed(script, opposite)};
}

std::vector<synthetic::Person> relayed_people(std::uint64_t seed, Timestamp begin) {
  std::vector<synthetic::Person> people;
  synthetic::Draw pauses{seed, kPause};
  Stint stint{-kStint, kStint, 0.0};  // the first one was there from the start
  for (std::size_t i = 0; i < 3; ++i) {
    WalkerScript script = script_of(seed, i, PathKind::Random);
    script.seed = seed;  // the same walk for all
    if (i == 2) stint.leaves = kNever;
    people.push_back(in_stints(placed(script, {}), begin, {stint}));
    const double pause = pauses.uniform(kMinPause, kMaxPause);
    stint = {stint.leaves + pause, stint.leaves + kStint, stint.behind + pause};
  }
  return people;
}

std::vector<synthetic::Person> returning_people(std::uint64_t seed, Timestamp begin) {
  constexpr double kAway = 20.0, kFirst = 8.0, kAgain = 26.0;  // [s]
  const double back = kFirst + synthetic::Draw{seed, kPause}.uniform(kMinPause, kMaxPause);
  std::vector<synthetic::Person> people = people_at_work(3, seed);
  people[0] =
      in_stints(people[0], begin, {{-kStint, kFirst}, {back, kAgain}, {kAgain + kAway, kNever}});
  for (const auto& [person, leaves] : {std::pair{1U, 14.0}, std::pair{2U, 16.0}}) {
    people[person] =
        in_stints(people[person], begin, {{-kStint, leaves}, {leaves + kAway, kNever}});
  }
  return people;
}

std::vector<synthetic::Person> booth_people(std::uint64_t seed, Timestamp begin) {
  constexpr int kStints = 16;
  WalkerScript script = script_of(seed, 0, PathKind::Line);
  script.reach = kReach;
  const Placing along_z{-heading_of_line(script), 0.0, 0.0};
  const synthetic::Person way = placed(script, along_z);
  const double origin = seconds(begin.time_since_epoch());
  synthetic::Draw pauses{seed, kPause};
  std::array<std::vector<Stint>, 2> stints;
  Stint stint{-kStint, 0.0, 0.0};
  for (std::size_t i = 0; i < kStints; ++i) {
    const double walked = origin + std::max(stint.enters, 0.0) - stint.behind;
    stint.leaves = next_middle(way, walked + kStint) + stint.behind - origin;
    stints[i % 2].push_back(stint);
    const double pause = pauses.uniform(kMinPause, kMaxPause);
    stint = {stint.leaves + pause, 0.0, stint.behind + pause};
  }
  WalkerScript other = script_of(seed, 1, PathKind::Line);
  other.seed = script.seed;  // both walk along the same line
  other.reach = kReach;
  return {in_stints(way, begin, stints[0]), in_stints(placed(other, along_z), begin, stints[1])};
}

std::vector<synthetic::Person> people_turning_back(std::uint64_t seed) {
  constexpr double kWay = 0.75;    // half of the way that each walks to and fro [m]
  constexpr double kShort = 0.29;  // how far from the middle they turn [m]
  std::vector<synthetic::Person> people;
  const double hour = synthetic::Draw{seed, kHour}.uniform(0.0, 10.0);
  for (std::size_t i = 0; i < 2; ++i) {
    WalkerScript script = script_of(seed, i, PathKind::Line);
    script.seed = seed;  // both walk alike
    script.reach = kWay;
    const double heading = heading_of_line(script);
    script.centre = (kWay + kShort) * Eigen::Vector2d(std::sin(heading), std::cos(heading));
    Placing placing;
    placing.yaw = -heading + (i == 0 ? 0.0 : std::numbers::pi);
    placing.delay = hour;
    people.push_back(placed(script, placing));
  }
  return people;
}

std::vector<synthetic::Person> side_by_side(std::uint64_t seed) {
  std::vector<synthetic::Person> people;
  const double yaw = synthetic::Draw{seed, kHour}.uniform(0.0, kFullTurn);
  for (const double aside : {-kBeside, kBeside}) {
    WalkerScript script = script_of(seed, people.size(), PathKind::Assembly);
    script.reach = kBench;
    people.push_back(placed(script, {yaw, aside, 0.0}));
  }
  return people;
}

std::vector<synthetic::Person> worker_beside_car(std::uint64_t seed) {
  WalkerScript script = script_of(seed, 0, PathKind::Assembly);
  const synthetic::Walker walker(script);
  const double heading = walker.path().at(Duration{0}).heading;
  script.centre = -kFromCar * Eigen::Vector2d(std::sin(heading), std::cos(heading));
  return {placed(script, {0.25 * kFullTurn - heading, 0.0, 0.0})};
}

synthetic::Occluder car_body() {
  synthetic::Occluder box;
  box.half = {0.4, 0.6, 0.9};
  box.world_from_box.translation().y() = box.half.y();
  return box;
}

synthetic::Occluder pillar() {
  synthetic::Occluder box;
  box.half = {0.2, 1.25, 0.2};
  box.world_from_box.translation() = Eigen::Vector3d(0.9, box.half.y(), 0.9);
  return box;
}

synthetic::Occluder table() {
  synthetic::Occluder box;
  box.half = {0.6, 0.375, 0.4};
  box.world_from_box.translation().y() = box.half.y();
  return box;
}

std::vector<Eigen::Isometry3d> places_behind_screen() {
  constexpr double kDistance = 3.0;  // [m]
  constexpr double kHeight = 1.6;    // [m]
  constexpr double kAside = 0.25;    // [m]
  std::vector<Eigen::Isometry3d> places;
  for (const double aside : {-kAside, kAside}) {
    places.push_back(
        synthetic::stand_sensor({-kDistance, kHeight, aside}, 0.25 * kFullTurn, deg(13)));
  }
  return places;
}

synthetic::Occluder screen() {
  // The box stands a third of the way from the crossing to the sensors.  So the part of the
  // crossing that neither sensor sees is 1.5 times as wide as the box, less half the distance
  // between the sensors.
  synthetic::Occluder box;
  box.half = {0.05, 1.25, 0.3};
  box.world_from_box.translation() = Eigen::Vector3d(-1.0, box.half.y(), 0.0);
  return box;
}

}  // namespace chorus::bench
