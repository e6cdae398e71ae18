// The points of a walk that the adjustment uses: what several sensors saw at one instant.
#pragma once

#include <optional>

#include "fusion-server/registration/floor_prior.h"
#include "fusion-server/registration/pair_registration.h"
#include "fusion-server/registration/point_elimination.h"

namespace chorus::registration {

/// A sensor during the adjustment.
struct Station {
  SensorId id;
  const Walker* walker = nullptr;
  Eigen::Isometry3d level_from_sensor = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d world_from_level = Eigen::Isometry3d::Identity();
  FloorPrior floor = {};  ///< How well its own floor is known; zero: not at all.
  bool master = false;
  bool level_held = false;  ///< Of the master where no floor is measured: tilt and height, too.
  bool fixed = false;       ///< True if it has too few common points to be moved.

  [[nodiscard]] Eigen::Isometry3d world_from_sensor() const {
    return world_from_level * level_from_sensor;
  }
};

/// A slot at one instant.
struct WalkPoint {
  double time = 0.0;     ///< Since the first instant [s].
  std::size_t slot = 0;  ///< Index into slots_of().
  PointMeasurements seen;
  PointMeasurements counted;  ///< What the adjustment counts: as seen, or whitened.
};

/// The points in order of time.  They are thinned out, but less so with many sensors, so that no
/// overlap is missed.
[[nodiscard]] std::vector<WalkPoint> points_of(const std::vector<Station>& stations,
                                               const RegistrationConfig& config);

/// How long the errors of the sights last: tau of the correlation exp(-lag / tau) of the residuals
/// of successive points of a slot [s]; zero if they are independent.  `fused`: the points as seen;
/// those of weight 0 are left out.
[[nodiscard]] double memory_of(const std::vector<WalkPoint>& points,
                               const std::vector<FusedPoint>& fused,
                               const std::vector<double>& weights);

/// Counts what is new in each point since the point of its slot before it:
/// m_k - exp(-lag / memory) m_(k-1) of the sensors that saw both.  If fewer than two sensors did,
/// the point is counted as seen.  docs/papers/registration.md, Section 8.
void whiten(std::vector<WalkPoint>& points, double memory);

/// The horizontal direction in which each point moves, computed from its places 0.3 s before and
/// after.  None while the point hardly moves.
[[nodiscard]] std::vector<std::optional<Eigen::Vector3d>> ways_of(
    const std::vector<WalkPoint>& points, const std::vector<Eigen::Vector3d>& places);

}  // namespace chorus::registration
