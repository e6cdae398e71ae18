#include "fusion-server/site/places.h"

#include <algorithm>
#include <cmath>
#include <ranges>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/base/units.h"
#include "common/geometry/error_radius.h"
#include "common/time/clock_estimate.h"
#include "fusion-server/registration/adjoint.h"
#include "fusion-server/site/joint_places.h"
#include "fusion-server/site/joint_terms.h"
#include "fusion-server/site/late_cells.h"
#include "fusion-server/site/loops.h"

namespace chorus::site {
namespace {

using registration::WalkTrack;

// The solver expects a floor below its sensors; a cell's world has its origin on the floor.
constexpr double kEye = 2.0;  // [m] by which the space of a cell is taken to be above its floor
// The origin stands where it stands; a covariance of zero would mean that nothing is known.
constexpr double kExactPlace = 1e-3;  // [m]
constexpr double kExactYaw = deg(0.01);
constexpr double kAnywhere = 1e6;  // [m]
/// How well the solver's clocks are known where joint_places() begins: hardly [s].
constexpr double kWalkClock = 0.3;

SensorFrame frame_of(const CellPeople& people) {
  SensorFrame frame;
  frame.sensor = people.cell;
  frame.sequence = people.sequence;
  frame.captured = frame.received = people.at;
  frame.floor = FloorPlane{Eigen::Vector3d::UnitY(), kEye};
  frame.clock_sigma = kUnknownClock;
  for (const Person& person : people.people) {
    if (person.carried && *person.carried > Duration{0}) continue;
    BodyFrame body{BodyId{person.body.value}, people.at, {}};
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!person.joints[i]) continue;
      body.skeleton.joints[i].position = *person.joints[i] - kEye * Eigen::Vector3d::UnitY();
      body.skeleton.joints[i].state = JointState::Tracked;
    }
    frame.bodies.push_back(body);
  }
  return frame;
}

registration::RegistrationConfig solver_config(const PlacesConfig& config) {
  registration::RegistrationConfig solver;
  solver.along_ratio = 1.0;  // a cell has no line of sight
  solver.min_distance = 0.0;
  solver.max_distance = kAnywhere;
  // What is found is where joint_places() begins, which says how well it is known.
  solver.max_position = solver.good_position = kAnywhere;
  solver.find_large_bias = false;
  solver.latency_sigma = Duration{0};
  solver.master = config.origin;
  return solver;
}

Eigen::Matrix<double, 6, 6> exact() {
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance.diagonal() << kExactYaw * kExactYaw, kExactYaw * kExactYaw, kExactYaw * kExactYaw,
      kExactPlace * kExactPlace, kExactPlace * kExactPlace, kExactPlace * kExactPlace;
  return covariance;
}

Eigen::Isometry3d world_from_cell(const Extrinsics& place) {
  return place.world_from_sensor * Eigen::Translation3d(0, -kEye, 0);
}

/// A covariance about the solver's origin of a cell, two metres above the cell's own.
Eigen::Matrix<double, 6, 6> covariance_of(const Extrinsics& place, const CellId& cell,
                                          const CellId& origin) {
  if (cell == origin) return exact();
  const Eigen::Vector3d down = place.world_from_sensor.linear() * Eigen::Vector3d(0, -kEye, 0);
  const registration::Matrix6 moved = registration::at_point(down);
  return moved * place.covariance * moved.transpose() + exact();
}

/// Each link with the worst loop that goes through it.
std::vector<CellLink> links_of(const std::vector<PairwiseRegistration>& edges) {
  const std::vector<CellLoop> loops = loops_of(edges);
  std::vector<CellLink> links;
  for (const PairwiseRegistration& edge : edges) {
    CellLink link{edge.target, edge.source, edge.rms, edge.pairs, {}};
    for (const CellLoop& loop : loops) {
      const bool through = std::ranges::count(loop.cells, edge.target) > 0 &&
                           std::ranges::count(loop.cells, edge.source) > 0;
      if (through) link.loop = std::max(link.loop.value_or(0.0), loop.closure);
    }
    links.push_back(link);
  }
  return links;
}

CellPlace place_of(const Registration& found, const CellId& cell, std::uint64_t version) {
  const Extrinsics& place = found.sensors.at(cell);
  const Eigen::Isometry3d site_from_world =
      world_from_cell(found.sensors.at(found.master)).inverse();
  CellPlace out{cell, site_from_world * world_from_cell(place)};
  Eigen::Matrix<double, 6, 6> turned = Eigen::Matrix<double, 6, 6>::Zero();
  turned.topLeftCorner<3, 3>() = turned.bottomRightCorner<3, 3>() = site_from_world.linear();
  out.covariance = turned * covariance_of(place, cell, found.master) * turned.transpose();
  const auto own = found.clocks.find(cell);
  const auto origin = found.clocks.find(found.master);
  if (own != found.clocks.end() && origin != found.clocks.end()) {
    out.clock_added = own->second.added - origin->second.added;
    out.clock_sigma = std::max<Duration>(own->second.sigma, std::chrono::milliseconds(1));
  }
  out.version = version;
  return out;
}

SitePlaces places_of(const Registration& found, std::uint64_t version) {
  SitePlaces places;
  places.origin = found.master;
  for (const auto& [cell, place] : found.sensors) {
    places.cells.push_back(place_of(found, cell, version));
  }
  for (const auto& [cell, verdict] : found.verdicts) {
    if (found.sensors.contains(cell)) continue;
    std::string reason = verdict.reasons.empty()
                             ? "nobody was seen by it and another cell at once: walk from one to "
                               "the other and back"
                             : fmt::format("{}", fmt::join(verdict.reasons, "; "));
    places.refused.push_back({cell, std::move(reason)});
  }
  return places;
}

struct Walked {
  std::vector<WalkTrack> tracks;
  std::vector<CellPath> paths;
  Timestamp last;
};

Walked walked_by(const std::vector<CellWalk>& walks) {
  Walked all;
  for (const CellWalk& walk : walks) {
    WalkTrack track{walk.cell, {}};
    for (const CellPeople& each : walk.seen) track.frames.push_back(frame_of(each));
    if (!walk.seen.empty()) all.last = std::max(all.last, walk.seen.back().at);
    all.tracks.push_back(std::move(track));
    all.paths.push_back(path_of(walk));
  }
  return all;
}

struct Found {
  SitePlaces places;
  std::vector<PairwiseRegistration> pairs;
};

/// Takes out the cells whose place is known too badly.
void refuse_wide(SitePlaces& places, const PlacesConfig& config) {
  std::vector<CellPlace> kept;
  for (CellPlace& cell : places.cells) {
    const double radius = radius_on_floor(cell.covariance);
    if (radius <= config.max_radius) {
      kept.push_back(std::move(cell));
      places.radius.push_back(radius);
      continue;
    }
    places.refused.push_back(
        {cell.cell, fmt::format("it would be placed only to within {:.2f} m, of {:.2f} m allowed: "
                                "walk to and fro where it and a neighbour both see you",
                                radius, config.max_radius)});
  }
  places.cells = std::move(kept);
}

/// Gives cells that the solver left out a place to begin from, where they fit to the others.
void take_late_cells(std::span<const CellPath> paths, SitePlaces& places) {
  const std::vector<CellPlace> placed = places.cells;
  std::erase_if(places.refused, [&](const CellRefusal& each) {
    const CellPath* path = path_in(paths, each.cell);
    auto place = path == nullptr ? std::nullopt : place_beside(*path, paths, placed);
    if (!place) return false;
    place->version = placed.back().version;
    place->covariance = placed.back().covariance;  // of tilt and height; the rest is found
    places.cells.push_back(std::move(*place));
    return true;
  });
}

/// The places that the solver found, made better with all cells and clocks at once.
Found all_together(const Registration& found, std::span<const CellPath> paths,
                   const PlacesConfig& config) {
  Found out{places_of(found, config.version), {}};
  std::ranges::partition(out.places.cells,
                         [&](const CellPlace& each) { return each.cell == out.places.origin; });
  take_late_cells(paths, out.places);
  if (auto joint = joint_places(paths, out.places.cells, kWalkClock)) {
    out.pairs = pairs_of(paths, *joint);
    out.places.cells = std::move(joint->cells);
  }
  refuse_wide(out.places, config);
  std::erase_if(out.pairs, [&](const PairwiseRegistration& pair) {
    const auto placed = [&](const CellId& cell) {
      return std::ranges::count(out.places.cells, cell, &CellPlace::cell) > 0;
    };
    return !placed(pair.target) || !placed(pair.source);
  });
  out.places.links = links_of(out.pairs);
  return out;
}

CellRefusal refusal(const Misfit& misfit) {
  return {misfit.cell,
          fmt::format("it does not fit: the loop {} ends {:.2f} m from where it began, and closes "
                      "without this cell{}",
                      fmt::join(misfit.worst.cells | std::views::transform(&CellId::str), "-"),
                      misfit.worst.closure,
                      misfit.alone ? ""
                                   : ", or without another one of the loop; was one moved "
                                     "during the walk?")};
}

}  // namespace

Result<SitePlaces> places_from_walks(const std::vector<CellWalk>& walks,
                                     const PlacesConfig& config) {
  auto [tracks, paths, last] = walked_by(walks);
  std::vector<CellRefusal> misfits;
  while (tracks.size() > 1) {
    const Registration found = registration::solve(tracks, last, solver_config(config));
    if (found.sensors.size() < 2) {
      return fail(
          ErrorCode::NotFound, "site",
          fmt::format("no two cells saw the walk together ({}): walk through the overlap of "
                      "each two neighbours, to and fro",
                      fmt::join(found.reasons, "; ")));
    }
    Found together = all_together(found, paths, config);
    const auto misfit = misfit_of(together.pairs, {config.loop_sigmas, config.least_loop});
    if (!misfit) {
      SitePlaces& places = together.places;
      places.refused.insert(places.refused.end(), misfits.begin(), misfits.end());
      return std::move(places);
    }
    misfits.push_back(refusal(*misfit));
    std::erase_if(tracks, [&](const WalkTrack& each) { return each.sensor == misfit->cell; });
  }
  return fail(ErrorCode::NotFound, "site", "two cells at least are wanted");
}

CellPlace after_move(CellPlace place, const Eigen::Isometry3d& new_from_old) {
  const Eigen::Isometry3d site_from_new = place.site_from_cell * new_from_old.inverse();
  const registration::Matrix6 moved =
      registration::at_point(site_from_new.translation() - place.site_from_cell.translation());
  place.covariance = (moved * place.covariance * moved.transpose()).eval();
  place.site_from_cell = site_from_new;
  ++place.version;
  return place;
}

}  // namespace chorus::site
