// People who meet, occlude one another, or work side by side: the scenes in which association is
// judged.
//
// World: the workspace centre is the origin, metres.  Each person is a function of the time since
// 1970 and of the seed.
#pragma once

#include <cstdint>
#include <vector>

#include "common/synthetic/scene.h"

namespace chorus::bench {

/// `count` people (2, 4 or 6) who walk to and fro along z through the middle; in pairs they pass
/// each other there again and again, with `passing` [m] between their necks.
[[nodiscard]] std::vector<synthetic::Person> crossing_people(std::size_t count, std::uint64_t seed,
                                                             double passing = 0.5);

/// Three people who follow the same path one after the other: each leaves the room on the way, and
/// the next enters at that place 0.3 to 2 s later.  The first is there at `begin`; nobody comes
/// back.
[[nodiscard]] std::vector<synthetic::Person> relayed_people(std::uint64_t seed, Timestamp begin);

/// Three people at work.  The first leaves for 0.3 to 2 s and, later, for 20 s; the other two leave
/// shortly after one another, for 20 s each.  All return to their working places.  All are there at
/// `begin`, and again from the 50th second on.
[[nodiscard]] std::vector<synthetic::Person> returning_people(std::uint64_t seed, Timestamp begin);

/// Two people who take turns to walk, each for at least ten seconds: when one has gone behind the
/// screen(), that one is out of the room, and 0.3 to 2 s later the other comes out on the other
/// side.
[[nodiscard]] std::vector<synthetic::Person> booth_people(std::uint64_t seed, Timestamp begin);

/// Two people of different builds who walk towards each other, turn back behind the screen() at the
/// same time, and come out on the side on which they went in.
[[nodiscard]] std::vector<synthetic::Person> people_turning_back(std::uint64_t seed);

/// Two people at assembly work, 1 m apart, who are in their places from the start.
[[nodiscard]] std::vector<synthetic::Person> side_by_side(std::uint64_t seed);

/// One person at assembly work at a long side of the car_body(), who faces it and reaches up to it;
/// the pillar() is on the other side.
[[nodiscard]] std::vector<synthetic::Person> worker_beside_car(std::uint64_t seed);

/// Distance from the middle beyond which nobody is in the room [m].
inline constexpr double kOutside = 50.0;

/// One person stands in the middle, the other walks around them at 0.8 m: each occludes the other
/// from every sensor in turn.
[[nodiscard]] std::vector<synthetic::Person> circled_person(std::uint64_t seed);

/// `count` people (at most 6), each moving about at a place of their own around the middle, never
/// closer than 0.4 m to one another.
[[nodiscard]] std::vector<synthetic::Person> people_at_work(std::size_t count, std::uint64_t seed);

/// Two people who walk around the middle at `radius` [m], opposite to each other.
[[nodiscard]] std::vector<synthetic::Person> people_around(double radius, std::uint64_t seed);

[[nodiscard]] synthetic::Occluder car_body();  ///< In the middle, 1.8 m long, 1.2 m high.
[[nodiscard]] synthetic::Occluder pillar();    ///< Near the middle, 0.4 m wide, to the ceiling.
[[nodiscard]] synthetic::Occluder table();     ///< In the middle, 1.2 x 0.8 m, 0.75 m high.

/// Two sensors next to each other that look along +x at people who cross along z, and a screen in
/// front of the place where they pass: for 0.65 m of the way neither sensor sees either of them.
[[nodiscard]] std::vector<Eigen::Isometry3d> places_behind_screen();
[[nodiscard]] synthetic::Occluder screen();

}  // namespace chorus::bench
