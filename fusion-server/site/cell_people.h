// What a cell tells its neighbours: the people it sees, and where it stands in the site.
//
// Metres and radians; right-handed, +y up.  The places of people are in the world of the cell that
// tells of them, and their stamps are by its clock; CellPlace leads from there to the site.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "common/body/located.h"
#include "fusion-server/associate/build.h"
#include "fusion-server/site/site_id.h"

namespace chorus::site {

/// One of a cell's people at one instant.
struct Person {
  PersonId body;                   ///< The cell's own id.
  std::optional<SiteId> site_id;   ///< None: not yet named.
  double site_certainty = 0.0;     ///< [0, 1]; that `site_id` is this person's.
  Timestamp since;                 ///< The first instant at which the cell published `body`.
  std::optional<Timestamp> named;  ///< The first instant at which `body` bore `site_id`.
  /// Pelvis (SpineBase) [m], its velocity [m/s], and the covariance of the place as the cell states
  /// it [m^2]; zero: it states none.
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Located joints;                  ///< The joints that are seen [m].
  associate::StatedBuild lengths;  ///< Lengths between joints, by which people are recognised.
  std::optional<double> sides;     ///< Probability that left and right are not exchanged.
  /// For how long no sensor of the cell has seen the person; none: seen now.
  std::optional<Duration> carried;
};

/// All people of a cell at one instant.
struct CellPeople {
  CellId cell;
  std::uint64_t boot = 0;      ///< Another one each time the cell starts; larger later.
  std::uint64_t sequence = 0;  ///< Of the cell's snapshot: larger in each message, with gaps.
  Timestamp at;                ///< The instant, by the cell's clock.
  std::vector<Person> people;
};

/// Where a cell stands in the site, and by how much its clock differs.
struct CellPlace {
  CellId cell;
  Eigen::Isometry3d site_from_cell = Eigen::Isometry3d::Identity();
  /// Covariance of (rotation vector, place) in the site's axes [rad^2, rad m, m^2]; zero: exact, or
  /// nothing is known (SiteConfig then says how well).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Duration clock_added{0};  ///< Added to the cell's stamps: the site's clock minus the cell's.
  Duration clock_sigma{0};  ///< Standard deviation; zero: as SiteConfig says.
  std::uint64_t version = 0;
};

}  // namespace chorus::site
