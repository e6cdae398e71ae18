#include "tests/bench/methods/pair_estimators.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/geometry/plane.h"
#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"
#include "fusion-server/registration/pairs.h"

namespace chorus::bench {
namespace {

using namespace registration;

constexpr double kSpeed = 1.0;           // one second counts as this many metres
constexpr int kYawSeeds = 24;            // as in registration/icp.cpp
constexpr int kIterations = 40;          // as in registration/icp.cpp
constexpr double kKeptShare = 0.9;       // as in registration/icp.cpp
constexpr std::size_t kMaxPoints = 300;  // as in registration/icp.cpp
constexpr std::size_t kMinPoints = 10;
constexpr double kSettled = 1e-6;  // [m], [rad]

/// Transforms that level the spaces of both skeletons, if both floors are known.
struct Levels {
  bool both = false;
  Eigen::Isometry3d level_from_target = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d level_from_source = Eigen::Isometry3d::Identity();

  [[nodiscard]] Result<RigidFit> fit(const std::vector<Eigen::Vector3d>& source,
                                     const std::vector<Eigen::Vector3d>& target,
                                     const std::vector<double>& weights = {}) const {
    return both ? fit_yaw(source, target, weights) : fit_rigid(source, target, weights);
  }
};

Levels levels_of(const Walker& target, const Walker& source, const RegistrationConfig& config) {
  Levels levels;
  levels.both = config.use_floor && target.floor.floor && source.floor.floor;
  if (!levels.both) return levels;
  levels.level_from_target = level(*target.floor.floor);
  levels.level_from_source = level(*source.floor.floor);
  return levels;
}

struct Stamped {
  double time = 0.0;  ///< [s]
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
};
using StampedTrail = std::vector<Stamped>;  ///< In order of time.

/// The neck positions of one side while the other side saw a body, too; at most kMaxPoints of them,
/// evenly chosen.
StampedTrail necks_of(const Trail& trail, const Trail& other,
                      const Eigen::Isometry3d& level_from_sensor, Duration max_gap) {
  StampedTrail all;
  TrailReader elsewhere(other, max_gap);
  for (const TrailFrame& frame : trail.frames) {
    if (!frame.has(0) || !elsewhere.at(frame.captured)) continue;
    const Timestamp origin = std::min(trail.frames.front().captured, other.frames.front().captured);
    all.push_back({seconds(frame.captured - origin), level_from_sensor * frame.points[0]});
  }
  const std::size_t step = std::max<std::size_t>(1, (all.size() + kMaxPoints - 1) / kMaxPoints);
  StampedTrail thin;
  for (std::size_t i = 0; i < all.size(); i += step) thin.push_back(all[i]);
  return thin;
}

Eigen::Vector3d centroid(const StampedTrail& trail) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Stamped& each : trail) sum += each.x;
  return sum / static_cast<double>(trail.size());
}

struct Match {
  double distance = std::numeric_limits<double>::infinity();  ///< In four dimensions [m].
  std::size_t source = 0;
  std::size_t target = 0;
};

/// Searches outward from the same time; stops where time alone exceeds the best distance so far.
Match nearest(const StampedTrail& target, const Stamped& point) {
  Match best;
  const auto here = std::lower_bound(target.begin(), target.end(), point.time,
                                     [](const Stamped& a, double time) { return a.time < time; });
  const auto look = [&](const Stamped& other) {
    const double apart = kSpeed * std::abs(other.time - point.time);
    if (apart >= best.distance) return false;
    const double distance = std::hypot(apart, (other.x - point.x).norm());
    if (distance < best.distance) {
      best.distance = distance;
      best.target = static_cast<std::size_t>(&other - target.data());
    }
    return true;
  };
  for (auto at = here; at != target.end() && look(*at); ++at) {
  }
  for (auto at = here; at != target.begin() && look(*std::prev(at)); --at) {
  }
  return best;
}

std::vector<Match> best_matches(const StampedTrail& source, const StampedTrail& target,
                                const Eigen::Isometry3d& target_from_source) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < source.size(); ++i) {
    matches.push_back(nearest(target, {source[i].time, target_from_source * source[i].x}));
    matches.back().source = i;
  }
  std::sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) {
    return std::tie(a.distance, a.source) < std::tie(b.distance, b.source);
  });
  matches.resize(static_cast<std::size_t>(kKeptShare * static_cast<double>(matches.size())));
  return matches;
}

struct IcpState {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  double rms = std::numeric_limits<double>::infinity();  ///< In four dimensions [m].
  std::size_t matches = 0;
};

IcpState run_icp(const StampedTrail& source, const StampedTrail& target, const Levels& levels,
                 const Eigen::Isometry3d& start) {
  IcpState state{start};
  for (int i = 0; i < kIterations; ++i) {
    std::vector<Eigen::Vector3d> from;
    std::vector<Eigen::Vector3d> to;
    double squares = 0.0;
    for (const Match& match : best_matches(source, target, state.target_from_source)) {
      from.push_back(source[match.source].x);
      to.push_back(target[match.target].x);
      squares += match.distance * match.distance;
    }
    const auto fit = levels.fit(from, to);
    if (!fit) return {};
    const Eigen::Isometry3d step = fit->target_from_source * state.target_from_source.inverse();
    state = {fit->target_from_source, std::sqrt(squares / static_cast<double>(from.size())),
             from.size()};
    if ((step.matrix() - Eigen::Matrix4d::Identity()).norm() < kSettled) break;
  }
  return state;
}

IcpState best_of_seeds(const StampedTrail& source, const StampedTrail& target,
                       const Levels& levels) {
  IcpState best;
  for (int i = 0; i < kYawSeeds; ++i) {
    Eigen::Isometry3d start(about_y(2.0 * std::numbers::pi * i / kYawSeeds));
    start.translation() = centroid(target) - start.linear() * centroid(source);
    const IcpState state = run_icp(source, target, levels, start);
    if (state.rms < best.rms) best = state;
  }
  if (levels.both) best.target_from_source.translation().y() = 0;  // by the floors
  return best;
}

PairwiseRegistration edge_of(const Walker& target, const Walker& source, const Levels& levels,
                             const Eigen::Isometry3d& level_from_level) {
  PairwiseRegistration edge{target.trail.sensor, source.trail.sensor};
  edge.target_from_source =
      levels.level_from_target.inverse() * level_from_level * levels.level_from_source;
  return edge;
}

Error refusal(const Walker& target, const Walker& source, ErrorCode code, std::string why) {
  return {code, target.trail.sensor.str() + " and " + source.trail.sensor.str(), std::move(why)};
}

/// rms distance from the centroid, horizontally [m].
double spread_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : points) sum += x;
  const Eigen::Vector3d middle = sum / static_cast<double>(points.size());
  double squares = 0.0;
  for (const Eigen::Vector3d& x : points) {
    const Eigen::Vector3d off = x - middle;
    squares += off.x() * off.x() + off.z() * off.z();
  }
  return std::sqrt(squares / static_cast<double>(points.size()));
}

/// Refuses a walk that is too narrow and an edge whose rms is too large, by our limits; our method
/// also refuses pairs with too few inliers.
Result<PairwiseRegistration> unless_refused(PairwiseRegistration edge, const Walker& target,
                                            const Walker& source,
                                            const RegistrationConfig& config) {
  if (edge.spread < config.min_spread) {
    return tl::unexpected(refusal(target, source, ErrorCode::Unavailable, "walk further out"));
  }
  if (edge.rms > config.max_edge_rms) {
    return tl::unexpected(refusal(target, source, ErrorCode::Conflict, "the two disagree"));
  }
  return edge;
}

}  // namespace

PairEstimator trajectory_icp(const RegistrationConfig& config) {
  return [config](const Walker& target, const Walker& source) -> Result<PairwiseRegistration> {
    const Levels levels = levels_of(target, source, config);
    const StampedTrail to =
        necks_of(target.trail, source.trail, levels.level_from_target, config.max_gap);
    const StampedTrail from =
        necks_of(source.trail, target.trail, levels.level_from_source, config.max_gap);
    const bool enough = to.size() >= kMinPoints && from.size() >= kMinPoints;
    const IcpState best = enough ? best_of_seeds(from, to, levels) : IcpState{};
    if (best.matches == 0)
      return tl::unexpected(refusal(target, source, ErrorCode::NotFound, "too little together"));
    PairwiseRegistration edge = edge_of(target, source, levels, best.target_from_source);
    edge.rms = edge.icp_rms = best.rms;
    edge.pairs = from.size();
    edge.inliers = best.matches;
    std::vector<Eigen::Vector3d> seen;
    for (const Stamped& each : to) seen.push_back(each.x);
    edge.spread = spread_of(seen);
    return unless_refused(std::move(edge), target, source, config);
  };
}

PairEstimator closed_form(const RegistrationConfig& config) {
  return [config](const Walker& target, const Walker& source) -> Result<PairwiseRegistration> {
    const Levels levels = levels_of(target, source, config);
    std::vector<Pair> pairs = pair_up(target.trail, source.trail, config).pairs;
    if (pairs.size() < config.min_pairs)
      return tl::unexpected(refusal(target, source, ErrorCode::NotFound, "too little together"));
    std::vector<Eigen::Vector3d> from;
    std::vector<Eigen::Vector3d> to;
    std::vector<double> weights;
    for (const Pair& pair : pairs) {
      from.push_back(levels.level_from_source * pair.x_in_source);
      to.push_back(levels.level_from_target * pair.x_in_target);
      weights.push_back(1.0 / (pair.sigma * pair.sigma));
    }
    const auto fit = levels.fit(from, to, weights);
    if (!fit) return pass(fit);
    PairwiseRegistration edge = edge_of(target, source, levels, fit->target_from_source);
    edge.rms = edge.icp_rms = fit->rms;
    edge.pairs = edge.inliers = pairs.size();
    edge.spread = spread_of(to);
    return unless_refused(std::move(edge), target, source, config);
  };
}

}  // namespace chorus::bench
