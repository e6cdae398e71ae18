// Time-paired correspondences: where two sensors saw the same joint at exactly the same instant.
//
// The target's trail is interpolated at the source's capture times (Otto 5.2.4), so sensors that
// are not synchronised give simultaneous points. docs/papers/registration.md, Section 2.
#pragma once

#include <optional>
#include <vector>

#include "fusion-server/registration/trail.h"

namespace chorus::registration {

/// A trail at one instant.
struct TrailMoment {
  TrailFrame frame;
  double speed = 0.0;  ///< Speed of the mean of the slots [m/s].
};

/// Reads a trail at increasing instants.
class TrailReader {
 public:
  TrailReader(const Trail& trail, Duration max_gap) : frames_(trail.frames), max_gap_(max_gap) {}

  /// Instants must not decrease. None unless there is a frame at the instant, or two frames of one
  /// body, at most max_gap apart, enclose it.
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
  double sigma = 0.0;  ///< Standard deviation of the difference, from the slot [m].
  std::size_t slot = 0;
  /// Index of the source frame among the paired frames; simultaneous pairs have the same index.
  std::size_t instant = 0;
  double time = 0.0;  ///< Time of the instant since the first frame of the source [s].
};

struct Pairing {
  std::vector<Pair> pairs;
  std::size_t instants = 0;      ///< Source frames for which there are pairs.
  std::size_t together = 0;      ///< Source frames at whose instant the target saw a body, too.
  std::size_t resting = 0;       ///< Frames of `together` at which the person had hardly moved.
  std::size_t too_fast = 0;      ///< Frames of `together` rejected by max_speed.
  std::size_t out_of_range = 0;  ///< Frames of `together` rejected by min_distance or max_distance.
};

[[nodiscard]] Pairing pair_up(const Trail& target, const Trail& source,
                              const RegistrationConfig& config);

}  // namespace chorus::registration
