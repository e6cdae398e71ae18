// Places of cells from marks on the floor that two cells know (places.h).
#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "common/geometry/error_radius.h"
#include "common/geometry/rigid_fit.h"
#include "fusion-server/site/loops.h"
#include "fusion-server/site/places.h"

namespace chorus::site {
namespace {

constexpr double kByHand = 0.02;     // [m] by which people put a mark beside its place, 1 sigma
constexpr double kTooFarOff = 0.10;  // [m] rms: left and right exchanged, or another mark

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Of marks measured to kByHand in both cells: better the more there are, and the wider apart.
Matrix6 mark_covariance(std::span<const Eigen::Vector3d> marks, const Eigen::Vector3d& about) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& each : marks) middle += each / static_cast<double>(marks.size());
  double spread = 0.0;
  for (const auto& each : marks) spread += (each - middle).squaredNorm();
  const double variance = 2.0 * kByHand * kByHand;
  const double turn = variance / std::max(spread, 1e-6);
  Matrix6 covariance = Matrix6::Zero();
  const double place =
      variance / static_cast<double>(marks.size()) + turn * (about - middle).squaredNorm();
  covariance.diagonal() << 1e-8, turn, 1e-8, place, variance, place;
  return covariance;
}

Result<PairwiseRegistration> link_of(const CellId& first, const CellId& second,
                                     const std::vector<CellMark>& marks) {
  std::vector<Eigen::Vector3d> target;
  std::vector<Eigen::Vector3d> source;
  for (const CellMark& mark : marks) {
    target.push_back(mark.x_in_first);
    source.push_back(mark.x_in_second);
  }
  const std::string where = first.str() + " and " + second.str();
  if (marks.size() < 2)
    return fail(ErrorCode::InvalidArgument, where, "two marks at least are wanted");
  const auto fit = fit_yaw(source, target);
  if (!fit) return pass(fit);
  if (!(fit->rms <= kTooFarOff))
    return fail(ErrorCode::Conflict, where,
                fmt::format("the marks do not fit one another: {:.2f} m off; is one of them "
                            "another mark, or x taken for z?",
                            fit->rms));
  PairwiseRegistration link;
  link.target = first;
  link.source = second;
  link.target_from_source = fit->target_from_source;
  link.rms = fit->rms;
  link.pairs = link.inliers = marks.size();
  link.covariance = mark_covariance(target, fit->target_from_source.translation());
  return link;
}

Result<std::vector<PairwiseRegistration>> links_from(const std::vector<CellMark>& marks) {
  std::map<std::pair<CellId, CellId>, std::vector<CellMark>> by_pair;
  for (CellMark mark : marks) {
    if (!mark.x_in_first.allFinite() || !mark.x_in_second.allFinite() || mark.first == mark.second)
      return fail(ErrorCode::InvalidArgument, mark.first.str() + " and " + mark.second.str(),
                  "a mark wants two cells and finite places");
    if (mark.second < mark.first) {
      std::swap(mark.first, mark.second);
      std::swap(mark.x_in_first, mark.x_in_second);
    }
    by_pair[{mark.first, mark.second}].push_back(mark);
  }
  std::vector<PairwiseRegistration> links;
  for (const auto& [pair, own] : by_pair) {
    auto link = link_of(pair.first, pair.second, own);
    if (!link) return pass(link);
    links.push_back(std::move(*link));
  }
  return links;
}

/// Every cell that links reach, along the fewest of them; variances add up.
std::vector<CellPlace> chained(const std::vector<PairwiseRegistration>& links, const CellId& origin,
                               std::uint64_t version) {
  CellPlace first{origin};
  first.covariance.diagonal() << 1e-8, 1e-8, 1e-8, 1e-6, 1e-6, 1e-6;
  first.version = version;
  std::vector<CellPlace> places{first};
  std::set<CellId> reached{origin};
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const PairwiseRegistration& link : links) {
      const CellPlace from = places[i];
      const bool forward = link.target == from.cell;
      if (!forward && link.source != from.cell) continue;
      const CellId& to = forward ? link.source : link.target;
      if (!reached.insert(to).second) continue;
      const Eigen::Isometry3d step =
          forward ? link.target_from_source : link.target_from_source.inverse();
      CellPlace next{to, from.site_from_cell * step};
      next.covariance = from.covariance + link.covariance;
      const double turn = from.covariance(1, 1) * step.translation().squaredNorm();
      next.covariance(3, 3) += turn;
      next.covariance(5, 5) += turn;
      next.version = version;
      places.push_back(next);
    }
  }
  std::ranges::sort(places, {}, &CellPlace::cell);
  return places;
}

}  // namespace

Result<SitePlaces> places_from_marks(const std::vector<CellMark>& marks,
                                     const PlacesConfig& config) {
  auto links = links_from(marks);
  if (!links) return pass(links);
  if (links->empty())
    return fail(ErrorCode::NotFound, "site", "no marks: two that both cells know are wanted");
  SitePlaces places;
  if (const auto misfit = misfit_of(*links, {config.loop_sigmas, config.least_loop})) {
    places.refused.push_back(
        {misfit->cell, fmt::format("its marks do not fit: a loop ends {:.2f} m from where "
                                   "it began",
                                   misfit->worst.closure)});
    std::erase_if(*links, [&](const auto& link) {
      return link.target == misfit->cell || link.source == misfit->cell;
    });
  }
  if (links->empty()) return fail(ErrorCode::Conflict, "site", places.refused.front().reason);
  places.origin = config.origin.value_or(links->front().target);
  places.cells = chained(*links, places.origin, config.version);
  for (const CellPlace& place : places.cells)
    places.radius.push_back(radius_on_floor(place.covariance));
  for (const auto& link : *links)
    places.links.push_back({link.target, link.source, link.rms, link.pairs, {}});
  return places;
}

}  // namespace chorus::site
