// Time-paired correspondences: where was the same joint for the other sensor at that very instant?
//
// The target's trail is interpolated at the source's capture times (Otto 5.2.4), so unsynchronised
// sensors give simultaneous points.
#pragma once

#include <vector>

#include "fusion-server/registration/trail.h"

namespace chorus::registration {

struct Pair {
  Eigen::Vector3d x_in_target;
  Eigen::Vector3d x_in_source;
  double sigma = 0.0;  ///< Of the difference, as far as the slot tells [m].
  std::size_t slot = 0;
  std::size_t instant =
      0;  ///< Counts the source frames that were paired; groups simultaneous pairs.
};

struct Pairing {
  std::vector<Pair> pairs;
  std::size_t instants = 0;      ///< Source frames that gave pairs.
  std::size_t together = 0;      ///< Source frames at whose instant the target saw somebody too.
  std::size_t too_fast = 0;      ///< ... of these, refused by max_speed.
  std::size_t out_of_range = 0;  ///< ... of these, refused by min_distance or max_distance.
};

[[nodiscard]] Pairing pair_up(const Trail& target, const Trail& source,
                              const RegistrationConfig& config);

}  // namespace chorus::registration
