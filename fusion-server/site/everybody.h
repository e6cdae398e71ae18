// Everybody in the site, each once, from what all cells tell.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/site/names.h"
#include "fusion-server/site/site.h"

namespace chorus::site {

/// In the order of ids.  A person's figures are those of the cell that answers for them; if it does
/// not see them, of the cell that states the smallest error.
[[nodiscard]] std::vector<SitePerson> everybody_of(const Hearing& hearing, const Names& names,
                                                   const SiteConfig& config);

/// Mean variance of a stated place on the floor [m^2]; where nothing is stated, a large one.
[[nodiscard]] double stated_variance(const Eigen::Matrix3d& covariance, const SiteConfig& config);

}  // namespace chorus::site
