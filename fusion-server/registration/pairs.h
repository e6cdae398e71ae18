// Time-paired correspondences: where the other sensor saw the same joint at that very instant.
//
// The target's trail is interpolated at the source's capture times (Otto 5.2.4), so unsynchronised
// sensors give simultaneous points.  docs/papers/registration.md, Section 2.
#pragma once

#include <optional>
#include <vector>

#include "fusion-server/registration/trail.h"

namespace chorus::registration {

/// A trail at one instant.
struct TrailMoment {
  TrailFrame frame;
  double speed = 0.0;  ///< Mean over the slots [m/s].
};

/// Walks along a trail as the instants advance.
class TrailReader {
 public:
  TrailReader(const Trail& trail, Duration max_gap) : frames_(trail.frames), max_gap_(max_gap) {}

  /// Instants must not go back.  None unless a narrow bracket of one body holds the instant.
  std::optional<TrailMoment> at(Timestamp instant);

 private:
  const std::vector<TrailFrame>& frames_;
  Duration max_gap_;
  std::size_t next_ = 0;
};

struct Pair {
  Eigen::Vector3d x_in_target;
  Eigen::Vector3d x_in_source;
  Eigen::Vector3d ray_in_target;  ///< Unit line of sight of the target sensor.
  Eigen::Vector3d ray_in_source;
  double sigma = 0.0;  ///< Of the difference, as far as the slot determines it [m].
  std::size_t slot = 0;
  /// Number of the source frame among the paired ones; groups simultaneous pairs.
  std::size_t instant = 0;
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
