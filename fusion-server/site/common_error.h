// What two cells have in common by mistake: by how much one of them stands elsewhere than it says,
// and by how much its clock differs.
//
// A person whom both see at x is shown off by
//   r = d + yaw * n(x - pivot) + delay * v,   n(x, z) = (z, -x)
// on the floor (x, z), where v is the person's velocity.  e = (d, yaw, delay) is the same for all
// people seen by both, so each of them tells something about e, and e cancels where several people
// are matched at once.  It is learned as people are seen by both.
#pragma once

#include <Eigen/Core>

#include "fusion-server/site/cell_people.h"
#include "fusion-server/site/site_config.h"

namespace chorus::site {

/// e as a normal distribution; [m], [m], [rad], [s].
struct CommonError {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  Eigen::Vector2d pivot = Eigen::Vector2d::Zero();  ///< Site, (x, z) [m].
};

/// What one pair of bodies tells of e: `off` = `lever` * e + noise.
struct CommonTerm {
  Eigen::Vector2d off = Eigen::Vector2d::Zero();  ///< Our place minus theirs, (x, z) [m].
  Eigen::Matrix<double, 2, 4> lever = Eigen::Matrix<double, 2, 4>::Zero();
  Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();  ///< Without e [m^2].
};

/// From what the cells state of their places; at least as much as SiteConfig says.
[[nodiscard]] CommonError stated_error(const CellPlace& ours, const CellPlace& theirs,
                                       const SiteConfig& config);

/// Of where the cell's place shows a point of it, `x` in the site [m^2]: from the stated
/// covariance, or, where none is stated, as SiteConfig assumes.
[[nodiscard]] Eigen::Matrix3d covariance_at(const CellPlace& place, const Eigen::Vector3d& x,
                                            const SiteConfig& config);

/// d r / d e for a person at `x` [m] with `velocity` [m/s], both (x, z).
[[nodiscard]] Eigen::Matrix<double, 2, 4> lever_at(const CommonError& error,
                                                   const Eigen::Vector2d& x,
                                                   const Eigen::Vector2d& velocity);

/// Log density [1/m^2] of the term under `error`.
[[nodiscard]] double log_density(const CommonError& error, const CommonTerm& term);
/// `error` once the term is known to be of one person.
[[nodiscard]] CommonError updated(const CommonError& error, const CommonTerm& term);
/// `error` after `elapsed` seconds: cells are pushed, clocks drift.
void drift(CommonError& error, double elapsed);

}  // namespace chorus::site
