// What a depth camera sees of a person: tapered capsules of this person's girths, some of dark
// cloth.
//
// The fitter knows none of this; it has a body of its own (generic_body.h).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/body/skeleton.h"
#include "common/synthetic/depth/depth_profile.h"

namespace chorus::synthetic::depth {

/// The convex hull of two balls.
struct Taper {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< [m]
  double radius_from = 0.0;                        ///< [m]
  double radius_to = 0.0;                          ///< [m]
  bool dark = false;                               ///< Sends little light back.
};

/// Distance along the unit ray from the origin to the surface; none when it misses, the surface
/// lies behind or the origin is inside.
[[nodiscard]] std::optional<double> hit(const Taper& taper, const Eigen::Vector3d& ray);

enum class Cloth : std::uint8_t { Skin, Hair, Trunk, Legs };
inline constexpr std::size_t kCloths = 4;

/// How one person is built and dressed.
struct Build {
  double trunk = 1.0;  ///< Times the mean radii.
  double arms = 1.0;
  double legs = 1.0;
  double clothing = 0.0;  ///< On trunk, upper arms and legs [m]
  bool dark[kCloths] = {};
};

/// The same person looks the same to every sensor and in every run.
[[nodiscard]] Build draw_build(const BuildSpread& spread, std::uint64_t seed, std::size_t person);

/// Joints that are not finite leave their segments out.  Radii scale with the length of the trunk.
[[nodiscard]] std::vector<Taper> surface_of(const Skeleton<SensorSpace>& body, const Build& build);

}  // namespace chorus::synthetic::depth
