// How well answered people keep their identity beside the true ones.
//
// CLEAR-MOT matching: a true person keeps its answer as long as that is within reach, the rest is
// assigned one-to-one at least distance.  Horizontal distances [m].
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/time/timestamp.h"

namespace chorus::bench {

/// An answered person.
struct Claimed {
  std::uint64_t id = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< World x, z [m]
};

/// One instant: who is said to be where, and where everybody truly is (not finite: not in the
/// room).
struct Roll {
  Timestamp instant;
  std::vector<Claimed> claimed;
  std::vector<Eigen::Vector2d> exact;
};

struct IdentityConfig {
  double reach = 0.5;    ///< An answer further away is not that person [m].
  double ghost = 0.5;    ///< Share of its life that a track must follow somebody not to be a ghost.
  double lasting = 1.0;  ///< An id has followed a person, not just passed by, after so long [s].
};

struct Identity {
  std::size_t switches = 0;        ///< A person's answer changes its id.
  std::size_t fragmentations = 0;  ///< A person's answer ends and begins again.
  std::size_t ghosts = 0;          ///< Ids that mostly follow nobody.
  double coverage = 0.0;           ///< Share of people's instants that were answered.
  /// 2 IDTP / (people's instants + answers), ids assigned once for the whole time.
  double idf1 = 0.0;
  double minutes = 0.0;
  /// From when a person is there to its first answer, mean of those that were answered [s].
  double first_answer = 0.0;
  /// Times that an id followed a further person for a second or longer.
  std::size_t inherited = 0;
  std::size_t spare_ids = 0;  ///< Ids that follow people who had one already.
};

[[nodiscard]] Identity identity_of(const std::vector<Roll>& rolls,
                                   const IdentityConfig& config = {});

}  // namespace chorus::bench
