#include "fusion-server/registration/pair_registration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "common/base/median.h"
#include "common/geometry/rotation.h"
#include "fusion-server/registration/icp.h"
#include "fusion-server/registration/pairs.h"
#include "fusion-server/registration/refine.h"
#include "fusion-server/registration/robust_fit.h"

namespace chorus::registration {
namespace {

constexpr double kMinAgreement = 0.3;  // with a smaller fraction of inliers the result is refused
constexpr double kMinSlimness = 0.01;  // lambda2 / lambda1 of the walk: a line at 10 % lateral rms
constexpr double kBias = mm(10);       // view-dependent joint bias at 90 deg and beyond
constexpr std::size_t kMaxPairs = 6000;  // more take longer, and successive ones are redundant
constexpr double kLeastApart = 0.15;     // [m] the two halves of a walk may always differ by this
constexpr double kApartOfRms = 3.0;      // ... or by this multiple of the residuals
constexpr double kIcpReach = 0.10;       // [m] a neck point without a partner this close is ignored

/// Both sensors' spaces, levelled to y = 0 if both floors are known; unchanged otherwise.
struct Levelled {
  bool both = false;
  Eigen::Isometry3d level_from_target = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d level_from_source = Eigen::Isometry3d::Identity();
};

Levelled level_both(const Walker& target, const Walker& source, bool use_floor) {
  Levelled levelled;
  levelled.both = use_floor && target.floor.floor && source.floor.floor;
  if (!levelled.both) return levelled;
  levelled.level_from_target = level(*target.floor.floor);
  levelled.level_from_source = level(*source.floor.floor);
  return levelled;
}

std::string names(const Walker& target, const Walker& source) {
  return fmt::format("sensors {} and {}", target.trail.sensor.str(), source.trail.sensor.str());
}

Result<void> enough(const Pairing& pairing, const std::string& both,
                    const RegistrationConfig& config) {
  if (pairing.together == 0) {
    return fail(ErrorCode::NotFound, both, fmt::format("{} never saw the person together", both));
  }
  if (pairing.pairs.size() >= config.min_pairs) return {};
  std::string why =
      fmt::format("{} saw the person together only briefly: {} usable pairs of {} needed", both,
                  pairing.pairs.size(), config.min_pairs);
  if (pairing.too_fast > pairing.together / 2) why += "; walk more slowly";
  if (pairing.out_of_range > pairing.together / 2) {
    why += fmt::format("; stay between {:.1f} m and {:.1f} m from both", config.min_distance,
                       config.max_distance);
  }
  return fail(ErrorCode::Unavailable, both, why);
}

/// At most about kMaxPairs pairs: if there are more, every n-th instant is kept, with all joints.
std::vector<Pair> thinned(const Pairing& pairing) {
  const std::size_t keep_every = (pairing.pairs.size() + kMaxPairs - 1) / kMaxPairs;
  if (keep_every <= 1) return pairing.pairs;
  std::vector<Pair> kept;
  for (const Pair& pair : pairing.pairs) {
    if (pair.instant % keep_every == 0) kept.push_back(pair);
  }
  return kept;
}

void apply(std::vector<Pair>& pairs, const Levelled& levelled) {
  for (Pair& pair : pairs) {
    pair.x_in_target = levelled.level_from_target * pair.x_in_target;
    pair.x_in_source = levelled.level_from_source * pair.x_in_source;
    pair.ray_in_target = levelled.level_from_target.linear() * pair.ray_in_target;
    pair.ray_in_source = levelled.level_from_source.linear() * pair.ray_in_source;
  }
}

/// The extent of the walk: its two largest principal axes, for the slot seen most often (of equal
/// ones, the first).
struct Extent {
  double spread = 0.0;    ///< [m]
  double slimness = 1.0;  ///< lambda2 / lambda1
};

Extent extent_of(const std::vector<Pair>& pairs, const std::vector<double>& weights) {
  std::array<std::size_t, kJointCount> seen{};
  for (std::size_t i = 0; i < pairs.size(); ++i) seen[pairs[i].slot] += weights[i] > 0 ? 1 : 0;
  const auto slot =
      static_cast<std::size_t>(std::max_element(seen.begin(), seen.end()) - seen.begin());
  if (seen[slot] == 0) return {};
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  const auto each = [&](const auto& use) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (pairs[i].slot == slot && weights[i] > 0) use(pairs[i].x_in_target);
    }
  };
  each([&](const Eigen::Vector3d& x) { centre += x / static_cast<double>(seen[slot]); });
  each([&](const Eigen::Vector3d& x) { scatter += (x - centre) * (x - centre).transpose(); });
  scatter /= static_cast<double>(seen[slot]);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter, Eigen::EigenvaluesOnly);
  const double major = std::max(0.0, eigen.eigenvalues()[2]);
  const double minor = std::max(0.0, eigen.eigenvalues()[1]);
  return {std::sqrt(major + minor), major > 0 ? minor / major : 0.0};
}

/// The clouds of the slot of the first pair: the necks, unless the first frame had none or all
/// joints are paired.
void clouds_of(const std::vector<Pair>& pairs, std::vector<Eigen::Vector3d>& target,
               std::vector<Eigen::Vector3d>& source) {
  const std::size_t slot = pairs.front().slot;
  for (const Pair& pair : pairs) {
    if (pair.slot != slot) continue;
    target.push_back(pair.x_in_target);
    source.push_back(pair.x_in_source);
  }
}

/// Otto 5.2: ICP on the clouds of clouds_of(). Its pose replaces that of `refined` only if it costs
/// the timed pairs no more, because they contain more information. Returns the rms of the timed
/// pairs at ICP's pose, or at the given one if ICP fails [m].
double refine_with_icp(const std::vector<Pair>& pairs, Refined& refined, double along_ratio) {
  std::vector<Eigen::Vector3d> target;
  std::vector<Eigen::Vector3d> source;
  clouds_of(pairs, target, source);
  const auto icp = refine_by_icp(source, target, refined.target_from_source, kIcpReach);
  if (!icp) return rms_of(pairs, refined.weights, refined.target_from_source);
  Refined moved = refined;
  moved.target_from_source = icp->target_from_source;
  if (cost_of(pairs, moved, along_ratio) <= cost_of(pairs, refined, along_ratio)) refined = moved;
  return rms_of(pairs, moved.weights, moved.target_from_source);
}

/// Covariance of the bias that no length of walk removes; it grows with the angle between the
/// directions in which the sensors look.
Matrix6 bias_floor(const Eigen::Isometry3d& target_from_source) {
  const double angle = angular_distance(Eigen::Quaterniond(target_from_source.linear()),
                                        Eigen::Quaterniond::Identity());
  const double bias = kBias * std::min(1.0, angle / deg(90));
  Matrix6 covariance = Matrix6::Zero();
  covariance.bottomRightCorner<3, 3>() = bias * bias * Eigen::Matrix3d::Identity();
  return covariance;
}

Result<void> believable(const PairwiseRegistration& edge, const Extent& extent,
                        const std::string& both, const RegistrationConfig& config) {
  if (extent.spread < config.min_spread) {
    return fail(ErrorCode::Unavailable, both,
                fmt::format("{}: walk further out, the walk they share spread only {:.2f} m of "
                            "{:.2f} m needed",
                            both, extent.spread, config.min_spread));
  }
  const double agreement = static_cast<double>(edge.inliers) / static_cast<double>(edge.pairs);
  if (edge.rms <= config.max_edge_rms && agreement >= kMinAgreement) return {};
  return fail(
      ErrorCode::Conflict, both,
      fmt::format(
          "{} disagree about the walk: {:.0f} % of the pairs fit within {:.3f} m rms; check "
          "their clocks and that one person walks alone",
          both, 100.0 * agreement, edge.rms));
}

/// The pairs of one half of the walk.
std::vector<Pair> half_of(const std::vector<Pair>& pairs, bool second) {
  const std::size_t middle = pairs[pairs.size() / 2].instant;
  std::vector<Pair> half;
  std::ranges::copy_if(pairs, std::back_inserter(half),
                       [&](const Pair& pair) { return (pair.instant >= middle) == second; });
  return half;
}

/// The results for the two halves of the walk must be close to each other. A sensor that follows
/// somebody else may fit one part of a walk by chance, but hardly two.
Result<void> halves_agree(const std::vector<Pair>& pairs, double rms, Freedom freedom,
                          const std::string& both, double min_spread) {
  const std::vector<Pair> early = half_of(pairs, false);
  const std::vector<Pair> late = half_of(pairs, true);
  // A half in which the person stayed on one spot cannot be used for this comparison.
  for (const auto* half : {&early, &late}) {
    if (extent_of(*half, std::vector<double>(half->size(), 1.0)).spread < min_spread) return {};
  }
  const auto first = fit_robustly(early, freedom);
  const auto second = fit_robustly(late, freedom);
  if (!first || !second) return {};
  std::vector<double> apart;
  for (const Pair& pair : pairs) {
    apart.push_back((first->target_from_source * pair.x_in_source -
                     second->target_from_source * pair.x_in_source)
                        .norm());
  }
  const double typical = median(std::move(apart));
  if (typical <= std::max(kLeastApart, kApartOfRms * rms)) return {};
  return fail(ErrorCode::Conflict, both,
              fmt::format("{} disagree about the walk: its two halves put them {:.2f} m apart; "
                          "check their clocks and that one person walks alone",
                          both, typical));
}

/// A straight walk leaves the rotation about its own line open, unless floor or body height
/// determine that rotation.
Result<void> determined(const Extent& extent, bool levelled, const std::string& both,
                        JointChoice joints) {
  if (extent.slimness >= kMinSlimness || levelled || joints != JointChoice::Neck) return {};
  return fail(
      ErrorCode::Unavailable, both,
      fmt::format("{}: the walk was one line; walk across too, or let both see the floor", both));
}

Result<PairwiseRegistration> timed(const Walker& target, const Walker& source,
                                   const RegistrationConfig& config) {
  const std::string both = names(target, source);
  const Pairing pairing = pair_up(target.trail, source.trail, config);
  if (const auto ok = enough(pairing, both, config); !ok) return pass(ok);
  const Levelled levelled = level_both(target, source, config.use_floor);
  std::vector<Pair> pairs = thinned(pairing);
  apply(pairs, levelled);
  const auto fit = fit_robustly(pairs, levelled.both ? Freedom::Yaw : Freedom::Full);
  if (!fit) return fail(ErrorCode::Unavailable, both, both + ": " + fit.error().message);
  const FloorPrior prior = levelled.both ? kTwoFloors : FloorPrior{};
  Refined refined = refine(pairs, *fit, prior, config.along_ratio);
  const Extent extent = extent_of(pairs, refined.weights);
  if (const auto ok = determined(extent, levelled.both, both, config.joints); !ok) return pass(ok);
  PairwiseRegistration edge{target.trail.sensor, source.trail.sensor};
  edge.icp_rms = refine_with_icp(pairs, refined, config.along_ratio);
  edge.rms = rms_of(pairs, refined.weights, refined.target_from_source);
  edge.pairs = pairs.size();
  edge.inliers = static_cast<std::size_t>(std::count_if(
      refined.weights.begin(), refined.weights.end(), [](double w) { return w > 0; }));
  edge.spread = extent.spread;
  edge.inflation = refined.inflation;
  if (const auto ok = believable(edge, extent, both, config); !ok) return pass(ok);
  const Freedom freedom = levelled.both ? Freedom::Yaw : Freedom::Full;
  if (const auto ok = halves_agree(pairs, edge.rms, freedom, both, config.min_spread); !ok)
    return pass(ok);
  const Eigen::Isometry3d target_from_level = levelled.level_from_target.inverse();
  edge.target_from_source =
      target_from_level * refined.target_from_source * levelled.level_from_source;
  const Matrix6 turn = adjoint(target_from_level);
  edge.covariance =
      turn * (refined.covariance + bias_floor(edge.target_from_source)) * turn.transpose();
  return edge;
}

std::vector<Eigen::Vector3d> neck_cloud(const Trail& trail,
                                        const Eigen::Isometry3d& level_from_sensor) {
  std::vector<Eigen::Vector3d> cloud;
  for (const TrailFrame& frame : trail.frames) {
    if (frame.has(0)) cloud.push_back(level_from_sensor * frame.points[0]);
  }
  return cloud;
}

Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : cloud) sum += x;
  return sum / static_cast<double>(std::max<std::size_t>(1, cloud.size()));
}

/// Removes height, pitch and roll from the result of ICP, because both spaces are levelled already
/// (the paper's "floor plane estimation compensates").  `middle`, the centre of the source's cloud,
/// stays where ICP has put it on the floor.
Eigen::Isometry3d on_the_floor(const Eigen::Isometry3d& level_from_level,
                               const Eigen::Vector3d& middle) {
  Eigen::Isometry3d flat = Eigen::Isometry3d::Identity();
  flat.linear() = about_y(yaw_of(level_from_level.linear())).toRotationMatrix();
  flat.translation() = level_from_level * middle - flat.linear() * middle;
  flat.translation().y() = 0;
  return flat;
}

Result<PairwiseRegistration> untimed(const Walker& target, const Walker& source,
                                     const RegistrationConfig& config) {
  const std::string both = names(target, source);
  const Levelled levelled = level_both(target, source, config.use_floor);
  const auto to = neck_cloud(target.trail, levelled.level_from_target);
  const auto from = neck_cloud(source.trail, levelled.level_from_source);
  const auto fit = icp_from_yaw_seeds(from, to);
  if (!fit) return fail(ErrorCode::Unavailable, both, both + ": " + fit.error().message);
  const Eigen::Isometry3d level_from_level =
      levelled.both ? on_the_floor(fit->target_from_source, middle_of(from))
                    : fit->target_from_source;
  PairwiseRegistration edge{target.trail.sensor, source.trail.sensor};
  edge.rms = edge.icp_rms = fit->rms;
  edge.pairs = from.size();
  edge.inliers = fit->accepted;
  edge.spread = config.min_spread;
  edge.target_from_source =
      levelled.level_from_target.inverse() * level_from_level * levelled.level_from_source;
  return edge;
}

}  // namespace

Walker walker_of(const WalkTrack& walk, const RegistrationConfig& config) {
  const bool neck_only = config.method == PairMethod::IcpOnly;
  return {trail_of(walk, neck_only ? JointChoice::Neck : config.joints), floor_of(walk)};
}

Result<PairwiseRegistration> register_walkers(const Walker& target, const Walker& source,
                                              const RegistrationConfig& config) {
  return config.method == PairMethod::IcpOnly ? untimed(target, source, config)
                                              : timed(target, source, config);
}

Result<PairwiseRegistration> register_pair(const WalkTrack& target, const WalkTrack& source,
                                           const RegistrationConfig& config) {
  return register_walkers(walker_of(target, config), walker_of(source, config), config);
}

}  // namespace chorus::registration
