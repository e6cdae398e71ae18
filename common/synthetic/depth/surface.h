// What a depth camera sees of a person: tapered capsules with this person's girths, some of them of
// dark cloth.
//
// The fit does not know them; it has a body of its own (generic_body.h).
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
  bool dark = false;                               ///< True if it reflects little light.
};

/// Distance from the origin along the unit ray to the surface; none if the ray misses it or the
/// surface lies behind the origin.  The origin must be outside.
[[nodiscard]] std::optional<double> hit(const Taper& taper, const Eigen::Vector3d& ray);

enum class Cloth : std::uint8_t { Skin, Hair, Trunk, Legs };
inline constexpr std::size_t kCloths = 4;

/// How one person is built and dressed.
struct Build {
  double trunk = 1.0;  ///< Factor on the mean radii.
  double arms = 1.0;
  double legs = 1.0;
  double clothing = 0.0;  ///< Thickness of the clothing on trunk, upper arms and legs [m].
  bool dark[kCloths] = {};
};

/// Draws a person's build.  It depends only on these arguments, so it is the same for every sensor.
[[nodiscard]] Build draw_build(const BuildSpread& spread, std::uint64_t seed, std::size_t person);

/// The tapers of a person's body, without those whose ends are not finite.  Radii are in proportion
/// to the length of the trunk, within limits.
[[nodiscard]] std::vector<Taper> surface_of(const Skeleton<SensorSpace>& body, const Build& build);

}  // namespace chorus::synthetic::depth
