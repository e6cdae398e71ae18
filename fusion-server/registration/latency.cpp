#include "fusion-server/registration/latency.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "common/base/median.h"
#include "fusion-server/registration/offset_profile.h"
#include "fusion-server/registration/pair_latency.h"

namespace chorus::registration {
namespace {

constexpr double kKnownClock = 0.002;         // [s] as in time_offset.cpp
constexpr double kLeastLatencySigma = 0.001;  // [s] of a pair: views differ not only in time
constexpr double kOddPair = 3.0;              // sigmas from which a pair counts less and less
constexpr int kLatencyRounds = 10;
// An edge between two sensors that have this many counts for nothing: with 64 sensors, all edges
// would take seconds.
constexpr std::size_t kEnoughEdges = 5;
constexpr double kSignificant = 3.0;  // sigmas
constexpr double kWorthIt = 0.005;    // [s]

struct PairMeasured {
  std::size_t target;
  std::size_t source;
  Eigen::Isometry3d target_from_source;
  std::optional<PairLatency> found;
};

struct LatencyNetwork {
  std::vector<const WalkTrack*> tracks;
  std::vector<PairMeasured> pairs;
  Eigen::VectorXd latencies;
  Eigen::MatrixXd covariance;

  static Eigen::Index at(std::size_t sensor) { return static_cast<Eigen::Index>(sensor); }
  [[nodiscard]] double sigma_between(std::size_t a, std::size_t b) const {
    const double variance =
        covariance(at(a), at(a)) + covariance(at(b), at(b)) - 2.0 * covariance(at(a), at(b));
    return std::sqrt(std::max(0.0, variance));
  }
};

bool knows_its_clock(const WalkTrack& track) {
  std::vector<double> stated;
  stated.reserve(track.frames.size());
  for (const SensorFrame& frame : track.frames) stated.push_back(frame.clock_sigma);
  return !stated.empty() && median(std::move(stated)) < kKnownClock;
}

/// Where both sensors have a place, by that, else as the pair alone has it.
Eigen::Isometry3d place_of(const PairwiseRegistration& edge, const Registration& found) {
  const auto target = found.sensors.find(edge.target);
  const auto source = found.sensors.find(edge.source);
  if (target == found.sensors.end() || source == found.sensors.end())
    return edge.target_from_source;
  return target->second.world_from_sensor.inverse() * source->second.world_from_sensor;
}

LatencyNetwork network_of(const std::vector<WalkTrack>& walk, const Registration& found) {
  LatencyNetwork network;
  std::map<SensorId, std::size_t> numbers;
  for (const WalkTrack& track : walk) {
    if (!knows_its_clock(track)) continue;
    if (numbers.try_emplace(track.sensor, network.tracks.size()).second)
      network.tracks.push_back(&track);
  }
  std::vector<std::size_t> edges(network.tracks.size(), 0);
  for (const PairwiseRegistration& edge : found.edges) {
    const auto target = numbers.find(edge.target);
    const auto source = numbers.find(edge.source);
    if (target == numbers.end() || source == numbers.end()) continue;
    if (std::min(edges[target->second], edges[source->second]) >= kEnoughEdges) continue;
    ++edges[target->second];
    ++edges[source->second];
    network.pairs.push_back({target->second, source->second, place_of(edge, found), std::nullopt});
  }
  return network;
}

void measure_latencies(LatencyNetwork& network, const RegistrationConfig& config,
                       const PairSearch& search) {
  std::vector<Walker> walkers(network.tracks.size());
  search.for_each(walkers.size(), [&](std::size_t i) {
    if (!search.stopped()) walkers[i] = offset_walker(*network.tracks[i], config);
  });
  search.for_each(network.pairs.size(), [&](std::size_t i) {
    if (search.stopped()) return;
    PairMeasured& pair = network.pairs[i];
    pair.found =
        pair_latency(walkers[pair.target], walkers[pair.source], pair.target_from_source, config);
  });
}

/// One step of weighted least squares; from the second step on, pairs far from the last result
/// count less.
void solve_network(LatencyNetwork& network, double prior_sigma) {
  const auto size = LatencyNetwork::at(network.tracks.size());
  const bool first = network.latencies.size() == 0;
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(size, size) / (prior_sigma * prior_sigma);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  for (const PairMeasured& pair : network.pairs) {
    if (!pair.found) continue;
    const auto target = LatencyNetwork::at(pair.target);
    const auto source = LatencyNetwork::at(pair.source);
    const double sigma = std::hypot(pair.found->sigma, kLeastLatencySigma);
    double weight = 1.0 / (sigma * sigma);
    if (!first) {
      const double between = network.latencies[source] - network.latencies[target];
      const double off = (pair.found->latency - between) / (kOddPair * sigma);
      weight /= 1.0 + off * off;
    }
    information(target, target) += weight;
    information(source, source) += weight;
    information(target, source) -= weight;
    information(source, target) -= weight;
    right[source] += weight * pair.found->latency;
    right[target] -= weight * pair.found->latency;
  }
  network.covariance = information.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  network.latencies = network.covariance * right;
}

/// The sensor of the median latency; of two middle ones the earlier, since delays only add.
std::size_t middle_of(const LatencyNetwork& network) {
  std::vector<std::size_t> order(network.tracks.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {},
                           [&](std::size_t i) { return network.latencies[LatencyNetwork::at(i)]; });
  return order[(order.size() - 1) / 2];
}

void move_by(std::vector<WalkTrack>& walk, const Latencies& latencies, int times) {
  for (WalkTrack& track : walk) {
    const auto found = latencies.find(track.sensor);
    if (found == latencies.end()) continue;
    for (SensorFrame& frame : track.frames) move_in_time(frame, times * found->second.added());
  }
}

Latencies of_placed(Latencies latencies, const Registration& found) {
  std::erase_if(latencies, [&](const auto& each) { return !found.sensors.contains(each.first); });
  return latencies;
}

}  // namespace

Latencies latencies_of(const std::vector<WalkTrack>& walk, const Registration& found,
                       const RegistrationConfig& config, const PairSearch& search) {
  Latencies latencies;
  if (config.latency_sigma <= Duration{0} || config.method == PairMethod::IcpOnly) return latencies;
  LatencyNetwork network = network_of(walk, found);
  if (network.pairs.empty()) return latencies;
  measure_latencies(network, config, search);
  for (int i = 0; i < kLatencyRounds; ++i) solve_network(network, seconds(config.latency_sigma));
  const std::size_t middle = middle_of(network);
  for (std::size_t i = 0; i < network.tracks.size(); ++i) {
    const double later =
        network.latencies[LatencyNetwork::at(i)] - network.latencies[LatencyNetwork::at(middle)];
    const double sigma = network.sigma_between(i, middle);
    const bool sure = std::abs(later) > std::max(kSignificant * sigma, kWorthIt);
    latencies[network.tracks[i]->sensor] = {from_seconds(later), from_seconds(sigma), sure};
  }
  return latencies;
}

Registration without_latencies(std::vector<WalkTrack>& walk,
                               const std::function<Registration()>& solve,
                               const RegistrationConfig& config, const PairSearch& search) {
  Registration first = solve();
  first.latencies = latencies_of(walk, first, config, search);
  const auto applied = [](const auto& each) { return each.second.applied; };
  if (std::ranges::none_of(first.latencies, applied) || search.stopped()) {
    first.latencies = of_placed(first.latencies, first);
    return first;
  }
  move_by(walk, first.latencies, 1);
  Registration second = solve();
  if (second.sensors.size() >= first.sensors.size()) {
    second.latencies = of_placed(first.latencies, second);
    return second;
  }
  move_by(walk, first.latencies, -1);
  for (auto& [sensor, latency] : first.latencies) latency.applied = false;
  first.latencies = of_placed(first.latencies, first);
  return first;
}

}  // namespace chorus::registration
