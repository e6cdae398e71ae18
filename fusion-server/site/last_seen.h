// Where everybody was last seen, whichever cell saw them: whom a newcomer may be.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "fusion-server/site/heard_cell.h"

namespace chorus::site {

/// The lengths of a person as one cell knew them while one of its bodies showed the person.
struct Visit {
  CellId cell;
  PersonId body;
  associate::StatedBuild lengths;
};

/// The last sight of a person; in the site, by our clock.
struct LastSight {
  CellId cell;
  Timestamp at;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  associate::StatedBuild lengths;  ///< Of all visits.
  std::vector<Visit> visits = {};  ///< In which the name was not doubtful; the newest few.
};

/// Adds what is known of a visit, or replaces what was known of it, and renews `lengths`.
void learn(LastSight& sight, const Visit& visit);

using LastSights = std::map<SiteId, LastSight>;

/// Somebody whose id is not known yet: their first sight, and what has been learned since.
struct Newcomer {
  Timestamp at;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Site [m].
  associate::StatedBuild lengths;
  std::optional<Eigen::Vector3d> velocity = {};  ///< With which they came; site [m/s].
};

/// The people of a map in its order, as match_returning() takes them.
struct Gone {
  std::vector<SiteId> ids;
  std::vector<LastSight> sights;
};
[[nodiscard]] Gone listed(const LastSights& sights);

/// More people are not remembered at once.
inline constexpr std::size_t kMostSights = 10'000;

/// Keeps the newer sight, and the visits; that of somebody new is left out beyond kMostSights.
void remember(LastSights& sights, const SiteId& id, const LastSight& sight);
/// Forgets the sights of before `oldest`.
void forget_before(LastSights& sights, Timestamp oldest);

/// Log likelihood ratio that the newcomer is the person who was last seen there, against somebody
/// whom no cell has seen; none: too far away to have walked.
[[nodiscard]] std::optional<double> return_odds(const LastSight& missing, const Newcomer& newcomer,
                                                const associate::Repeatability& repeatability);

/// One row per newcomer, one column per missing person: probabilities, each missing person being at
/// most one of the newcomers.  Who cannot have walked to any newcomer is out of the question; of
/// the others the likeliest 64 are matched.
[[nodiscard]] JointMatch match_returning(std::span<const Newcomer> newcomers,
                                         std::span<const LastSight> missing,
                                         const associate::Repeatability& repeatability);

}  // namespace chorus::site
