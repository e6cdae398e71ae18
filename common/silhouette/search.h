// The paper's search (Madaras et al. 3.4, 3.5, Eqs. 1 and 2): silhouettes of the body, shifted over
// the floor, are compared with the distance field of the picture; the best shift is added to the
// last position.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/silhouette/body_shape.h"
#include "common/silhouette/evidence.h"

namespace chorus::silhouette {

struct SearchSettings {
  int shifts = 3;          ///< k: shifts in each of the eight directions.
  double shift = 0.10;     ///< d [m].
  double kernel_px = 3.0;  ///< Width of the silhouette's curve (Eq. 1) [px of the field].
};

struct SearchView {
  const Skeleton<WorldSpace>& body;  ///< At the last position.
  std::span<const ShapedBone> shape;
  const Eigen::Isometry3d& world_from_sensor;
  const Intrinsics& camera;
  const Evidence& evidence;
};

/// The body elsewhere.
[[nodiscard]] Skeleton<WorldSpace> shifted(const Skeleton<WorldSpace>& body,
                                           const Eigen::Vector3d& by);

struct SearchResult {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< Over the floor [m].
  double energy = 0.0;                              ///< Eq. 2 of the best [px of the field].
  /// True when a minimum that is not beside the best one is within a tenth of its energy.
  bool ambiguous = false;
};

/// Eq. 2 over 8 k + 1 silhouettes.  None when all silhouettes are empty: the person is not in the
/// picture.  (One that is empty never wins.)
[[nodiscard]] std::optional<SearchResult> search(const SearchView& view,
                                                 const SearchSettings& settings = {});

/// The region in which `search` may look: the body shifted by `reach` metres to all sides.  None
/// when a part of the body would be behind the camera.
[[nodiscard]] std::optional<Region> region_around(const SearchView& view, double reach);

/// Eq. 2 for one position: the mean distance along the silhouette; none if it is empty.
[[nodiscard]] std::optional<double> energy(std::span<const FlatCapsule> capsules,
                                           const Evidence& evidence, double kernel_px);

}  // namespace chorus::silhouette
