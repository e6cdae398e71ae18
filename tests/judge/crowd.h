// People who meet, hide one another, or work side by side: the scenes that association is judged
// by.
//
// World: the workspace centre is the origin, metres.  Everybody is a function of time since 1970
// and of the seed.
#pragma once

#include <cstdint>
#include <vector>

#include "common/synthetic/scene.h"

namespace chorus::bench {

/// `count` people (2, 4 or 6) who walk to and fro along z through the middle; two and two pass each
/// other there with `passing` [m] between their necks, again and again.
[[nodiscard]] std::vector<synthetic::Person> crossing_people(std::size_t count, std::uint64_t seed,
                                                             double passing = 0.5);

/// Three people, one after the other on one walk: each leaves the room somewhere and the next one
/// enters there, 0.3 to 2 s later.  The first is there at `begin`; nobody comes back.
[[nodiscard]] std::vector<synthetic::Person> relayed_people(std::uint64_t seed, Timestamp begin);

/// Three people at work.  The first goes out for 0.3 to 2 s and, later, for 20 s; the two others go
/// out soon after one another and stay out for 20 s each.  Everybody comes back to where they work.
/// All are there at `begin`, and again from its 50th second on.
[[nodiscard]] std::vector<synthetic::Person> returning_people(std::uint64_t seed, Timestamp begin);

/// Two who take turns in going through a booth: one goes behind the screen(), and 0.3 to 2 s later
/// the other one comes out on the other side, after stints of ten seconds at least.  Whoever is not
/// walking is out of the room.
[[nodiscard]] std::vector<synthetic::Person> booth_people(std::uint64_t seed, Timestamp begin);

/// Two at assembly work beside each other, 1 m apart, who stood there before anybody looked.
[[nodiscard]] std::vector<synthetic::Person> side_by_side(std::uint64_t seed);

/// Out of the room: further from the middle than anybody in it [m].
inline constexpr double kOutside = 50.0;

/// One stands in the middle, the other walks around them at 0.8 m: each hides the other from every
/// sensor in turn.
[[nodiscard]] std::vector<synthetic::Person> circled_person(std::uint64_t seed);

/// `count` people (at most 6), each wandering in a place of their own around the middle, never
/// closer than 0.4 m.
[[nodiscard]] std::vector<synthetic::Person> people_at_work(std::size_t count, std::uint64_t seed);

/// Two people walk around the middle opposite to each other at `radius` [m].
[[nodiscard]] std::vector<synthetic::Person> people_around(double radius, std::uint64_t seed);

[[nodiscard]] synthetic::Occluder car_body();  ///< In the middle, 1.8 m long, 1.2 m high.
[[nodiscard]] synthetic::Occluder pillar();    ///< Beside the middle, 0.4 m wide, to the ceiling.
[[nodiscard]] synthetic::Occluder table();     ///< In the middle, 1.2 x 0.8 m, 0.75 m high.

/// Two sensors beside each other that look along +x at people who cross along z, and a screen
/// before the place where they pass: for 0.65 m of the way neither sensor sees either of them.
[[nodiscard]] std::vector<Eigen::Isometry3d> places_behind_screen();
[[nodiscard]] synthetic::Occluder screen();

}  // namespace chorus::bench
