// How well the people that a method reports keep their identities, compared with the truth.
//
// CLEAR-MOT matching: a true person keeps the reported person it was matched with as long as that
// one is within reach; all others are matched one-to-one, with the least total distance.
// Horizontal distances [m].
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/time/timestamp.h"

namespace chorus::bench {

/// A person that the method reports.
struct Claimed {
  std::uint64_t id = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< World x, z [m]
};

/// One instant: the people that the method reports, and where everybody truly is (not finite: not
/// in the room).
struct Roll {
  Timestamp instant;
  std::vector<Claimed> claimed;
  std::vector<Eigen::Vector2d> exact;
};

struct IdentityConfig {
  double reach = 0.5;  ///< A person reported farther away than this is not that person [m].
  /// A track that follows people for a smaller fraction of its life is a ghost.
  double ghost = 0.5;
  double lasting = 1.0;  ///< After this time an id has followed a person, not just passed by [s].
};

struct Identity {
  std::size_t switches = 0;        ///< How often the id under which a person is reported changed.
  std::size_t fragmentations = 0;  ///< How often the track of a person ended and began again.
  std::size_t ghosts = 0;          ///< Ids that mostly followed nobody.
  double coverage = 0.0;           ///< Fraction of people's instants at which they are reported.
  /// 2 IDTP / (people's instants + reported bodies), with ids assigned once for all instants.
  double idf1 = 0.0;
  double minutes = 0.0;
  /// Mean time from a person's appearance until they are first reported [s]; people who never are
  /// do not count.
  double first_answer = 0.0;
  /// How often an id that had followed one person followed another one for a second or longer.
  std::size_t inherited = 0;
  std::size_t spare_ids = 0;  ///< Additional ids of people who already had one.
  /// The longest time for which somebody was reported where nobody was, and for which somebody in
  /// the room was not reported [s].
  double longest_false = 0.0, longest_unseen = 0.0;
};

[[nodiscard]] Identity identity_of(const std::vector<Roll>& rolls,
                                   const IdentityConfig& config = {});

}  // namespace chorus::bench
