#include "fusion-server/registration/time_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "common/base/median.h"
#include "fusion-server/registration/offset_interval.h"
#include "fusion-server/registration/offset_profile.h"

namespace chorus::registration {
namespace {

// [s] a pair known this well is not searched; corresponds to 2 mm of walk.
constexpr double kKnown = 0.002;
constexpr double kMostSearched = 1.1;  // [s]
constexpr double kSearchSigmas = 4.0;
constexpr double kLeastSigma = 0.001;  // [s] least sigma of a pair: views differ not only in time
constexpr double kExact = 1e-4;        // [s] a clock that is known exactly
constexpr double kOutlier = 3.0;       // sigmas from which a pair counts less and less
constexpr int kSolveIterations = 10;
constexpr double kMaxSpread = 0.05;  // [m] most that a place may vary over the possible offsets

/// What one pair measures: the correction of the source's stamps minus that of the target's.
struct Measured {
  std::size_t target;
  std::size_t source;
  double range;                      ///< Offsets from -range to +range were searched [s].
  std::optional<PairOffset> offset;  ///< None: it saw too little.
};

struct Network {
  std::vector<SensorId> sensors;
  std::vector<Walker> walkers;
  std::vector<double> priors;  ///< Sigma of each clock [s].
  std::vector<std::optional<Duration>> least_ages;
  std::vector<Measured> pairs;
  Eigen::VectorXd offsets;
  Eigen::MatrixXd covariance;

  [[nodiscard]] double between(const Measured& pair) const {
    return offsets[at(pair.source)] - offsets[at(pair.target)];
  }
  [[nodiscard]] double sigma_between(std::size_t a, std::size_t b) const {
    const double variance =
        covariance(at(a), at(a)) + covariance(at(b), at(b)) - 2.0 * covariance(at(a), at(b));
    return std::sqrt(std::max(0.0, variance));
  }
  static Eigen::Index at(std::size_t sensor) { return static_cast<Eigen::Index>(sensor); }
};

/// The median of the sigmas that the frames state.
double prior_of(const WalkTrack& track) {
  if (track.frames.empty()) return kExact;
  std::vector<double> stated;
  stated.reserve(track.frames.size());
  for (const SensorFrame& frame : track.frames) stated.push_back(frame.clock_sigma);
  return std::max(kExact, median(std::move(stated)));
}

/// The shortest time from a frame's capture, by its stamp, to its receipt.  One or two frames that
/// are younger than all others by more than the usual jitter are odd stamps, and do not count.
std::optional<Duration> least_age_of(const WalkTrack& track) {
  constexpr std::size_t kOdd = 2;
  constexpr Duration kJitter = std::chrono::milliseconds(20);
  std::vector<Duration> ages;
  for (const SensorFrame& frame : track.frames) {
    if (frame.received != Timestamp{}) ages.push_back(frame.received - frame.captured);
  }
  if (ages.empty()) return std::nullopt;
  std::ranges::sort(ages);
  return *std::ranges::lower_bound(ages, ages[std::min(kOdd, ages.size() - 1)] - kJitter);
}

/// Searches the offset of each pair for which that is worthwhile.
void measure(Network& network, const RegistrationConfig& config, const PairSearch& search) {
  const std::vector<Walker>& walkers = network.walkers;
  for (std::size_t target = 0; target < walkers.size(); ++target) {
    for (std::size_t source = target + 1; source < walkers.size(); ++source) {
      const double sigma = std::hypot(network.priors[target], network.priors[source]);
      if (sigma < kKnown) continue;
      const double range = std::min(kMostSearched, kSearchSigmas * sigma);
      network.pairs.push_back({target, source, range, std::nullopt});
    }
  }
  search.for_each(network.pairs.size(), [&](std::size_t i) {
    if (search.stopped()) return;
    Measured& pair = network.pairs[i];
    pair.offset =
        OffsetProfile(walkers[pair.target], walkers[pair.source], config, pair.range).best();
  });
}

double weight_of(const Network& network, const Measured& pair) {
  if (!pair.offset) return 0.0;
  const double sigma = std::hypot(pair.offset->sigma, kLeastSigma);
  if (network.offsets.size() == 0) return 1.0 / (sigma * sigma);
  const double off = (pair.offset->offset - network.between(pair)) / (kOutlier * sigma);
  return 1.0 / (sigma * sigma) / (1.0 + off * off);
}

/// One step of least squares over all pairs and priors; from the second step on, pairs far from the
/// last result count less.
void solve(Network& network) {
  const auto size = Network::at(network.sensors.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  for (std::size_t i = 0; i < network.priors.size(); ++i)
    information(Network::at(i), Network::at(i)) = 1.0 / (network.priors[i] * network.priors[i]);
  for (const Measured& pair : network.pairs) {
    const double weight = weight_of(network, pair);
    const auto target = Network::at(pair.target);
    const auto source = Network::at(pair.source);
    information(target, target) += weight;
    information(source, source) += weight;
    information(target, source) -= weight;
    information(source, target) -= weight;
    const double measured = pair.offset ? pair.offset->offset : 0.0;
    right[source] += weight * measured;
    right[target] -= weight * measured;
  }
  network.covariance = information.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  network.offsets = network.covariance * right;
}

/// How far the source's place moves over the offsets that remain possible [m]; infinite if that
/// cannot be determined.
double place_spread(const Network& network, const Measured& pair,
                    const RegistrationConfig& config) {
  const double middle = network.between(pair);
  const double sigma = network.sigma_between(pair.target, pair.source);
  if (sigma < kKnown) return 0.0;
  const OffsetProfile profile(network.walkers[pair.target], network.walkers[pair.source], config,
                              pair.range);
  std::vector<Eigen::Vector3d> places;
  for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const auto place = profile.place_at(middle + share * kSigmas95 * sigma);
    if (!place) return std::numeric_limits<double>::infinity();
    places.push_back(*place);
  }
  double spread = 0.0;
  for (const Eigen::Vector3d& a : places) {
    for (const Eigen::Vector3d& b : places) spread = std::max(spread, (a - b).norm());
  }
  return spread;
}

Error cannot_tell(const SensorId& target, const SensorId& source) {
  const std::string both = fmt::format("sensors {} and {}", target.str(), source.str());
  return {ErrorCode::Unavailable, both,
          fmt::format("walk straight once: the clocks of {} cannot be told from a circle or from "
                      "standing",
                      both)};
}

/// Adds to `clocks.open` each pair whose place varies by more than kMaxSpread, or than a good place
/// may be off, over the offsets that the walk does not exclude.
void mark_open(const Network& network, const RegistrationConfig& config, const PairSearch& search,
               WalkClocks& clocks) {
  std::vector<double> spreads(network.pairs.size(), 0.0);
  search.for_each(spreads.size(), [&](std::size_t i) {
    if (!search.stopped()) spreads[i] = place_spread(network, network.pairs[i], config);
  });
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    if (spreads[i] <= std::max(kMaxSpread, config.good_position)) continue;
    const Measured& pair = network.pairs[i];
    const SensorId& target = network.sensors[pair.target];
    const SensorId& source = network.sensors[pair.source];
    clocks.open.emplace(std::pair{target, source}, cannot_tell(target, source));
  }
}

/// All offsets relative to the clock that is known best; of equally well known ones, the first.
std::map<SensorId, ClockOffset> against_the_best(const Network& network) {
  const auto least = std::ranges::min_element(network.priors);
  const auto best = static_cast<std::size_t>(least - network.priors.begin());
  std::map<SensorId, ClockOffset> offsets;
  for (std::size_t i = 0; i < network.sensors.size(); ++i) {
    const double added = network.offsets[Network::at(i)] - network.offsets[Network::at(best)];
    offsets[network.sensors[i]] = {from_seconds(added),
                                   from_seconds(network.sigma_between(best, i)),
                                   from_seconds(network.priors[i]), network.least_ages[i]};
  }
  return offsets;
}

bool all_known(const std::vector<WalkTrack>& walk) {
  return std::ranges::all_of(
      walk, [](const WalkTrack& track) { return std::hypot(prior_of(track), kExact) < kKnown; });
}

}  // namespace

WalkClocks clocks_of(const std::vector<WalkTrack>& walk, const RegistrationConfig& config,
                     const PairSearch& search) {
  WalkClocks clocks;
  if (config.method == PairMethod::IcpOnly || all_known(walk)) return clocks;
  Network network;
  for (const WalkTrack& track : walk) {
    if (track.frames.empty()) continue;  // it has no clock to compare
    if (std::ranges::find(network.sensors, track.sensor) != network.sensors.end()) continue;
    network.sensors.push_back(track.sensor);
    network.priors.push_back(prior_of(track));
    network.least_ages.push_back(least_age_of(track));
    network.walkers.push_back(offset_walker(track, config));
  }
  measure(network, config, search);
  for (int i = 0; i < kSolveIterations; ++i) solve(network);
  clocks.offsets = against_the_best(network);
  mark_open(network, config, search, clocks);
  return clocks;
}

void bring_in_step(std::vector<WalkTrack>& walk, const WalkClocks& clocks) {
  for (WalkTrack& track : walk) {
    const auto found = clocks.offsets.find(track.sensor);
    if (found == clocks.offsets.end()) continue;
    for (SensorFrame& frame : track.frames) move_in_time(frame, found->second.added);
  }
}

PairEstimator unless_open(PairEstimator estimate, const WalkClocks& clocks) {
  if (clocks.open.empty()) return estimate;
  return [estimate = std::move(estimate), open = clocks.open](
             const Walker& target, const Walker& source) -> Result<PairwiseRegistration> {
    auto edge = estimate(target, source);
    const SensorId& a = target.trail.sensor;
    const SensorId& b = source.trail.sensor;
    auto found = open.find({a, b});
    if (found == open.end()) found = open.find({b, a});
    if (edge && found != open.end()) return tl::unexpected(found->second);
    return edge;
  };
}

std::map<SensorId, ClockOffset> offsets_of_placed(const WalkClocks& clocks,
                                                  const Registration& found) {
  auto offsets = clocks.offsets;
  std::erase_if(offsets, [&](const auto& each) { return !found.sensors.contains(each.first); });
  return offsets;
}

}  // namespace chorus::registration
