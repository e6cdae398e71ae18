// How another solve places the sensors that have a place: as well, better, worse, or elsewhere.
#pragma once

#include <optional>
#include <set>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "fusion-server/flow/registration.h"

namespace chorus::core {

/// How the candidate places a sensor that has a place already.
enum class Change {
  None,       ///< About as well as before.
  Better,     ///< At the same place, by a radius that is clearly smaller.
  Worse,      ///< At the same place, by a larger radius: a shorter or a narrower walk.
  Elsewhere,  ///< At another place: it was moved.
};

/// The transform from the candidate's world to the current one, from the sensors that both place,
/// without those in `moving`; none if they do not stand relative to one another as in the current
/// registration.
[[nodiscard]] std::optional<Eigen::Isometry3d> between_worlds(const Registration& current,
                                                              const Registration& candidate,
                                                              const std::set<SensorId>& moving);

/// Of a sensor that both place; `world_from_candidate` is between_worlds(), and none means that it
/// stands elsewhere.
[[nodiscard]] Change change_of(const Registration& current, const Registration& candidate,
                               const SensorId& sensor,
                               const std::optional<Eigen::Isometry3d>& world_from_candidate);

}  // namespace chorus::core
