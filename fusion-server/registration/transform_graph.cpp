#include "fusion-server/registration/transform_graph.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "fusion-server/registration/adjoint.h"

namespace chorus::registration {
namespace {

constexpr double kEdgeFloor = 0.002;  // [m] smallest error per hop, however long the walk
constexpr double kLever = 2.5;        // [m] sensor to walk; the best distance of Otto Eq. (1)
constexpr double kMinSpread = 0.01;   // [m]

/// An edge as seen from one of its ends.
struct Hop {
  SensorId to;
  Eigen::Isometry3d from_from_to = Eigen::Isometry3d::Identity();  ///< x_in_from = (.) x_in_to
  Matrix6 covariance = Matrix6::Zero();
  double error = 0.0;
};

/// T' = Exp(xi) T has the inverse T'^-1 = Exp(-Ad(T^-1) xi) T^-1.
Hop reversed(const PairwiseRegistration& edge) {
  const Eigen::Isometry3d source_from_target = edge.target_from_source.inverse();
  const Matrix6 turn = adjoint(source_from_target);
  return {edge.target, source_from_target, turn * edge.covariance * turn.transpose(),
          edge_error(edge)};
}

/// The hops that lead away from each sensor.
std::map<SensorId, std::vector<Hop>> hops_of(const std::vector<PairwiseRegistration>& edges) {
  std::map<SensorId, std::vector<Hop>> hops;
  for (const PairwiseRegistration& edge : edges) {
    hops[edge.target].push_back(
        {edge.source, edge.target_from_source, edge.covariance, edge_error(edge)});
    hops[edge.source].push_back(reversed(edge));
  }
  return hops;
}

Chain extend(const Chain& chain, const Hop& hop) {
  Chain longer = chain;
  longer.master_from_sensor = chain.master_from_sensor * hop.from_from_to;
  const Matrix6 turn = adjoint(chain.master_from_sensor);
  longer.covariance = chain.covariance + turn * hop.covariance * turn.transpose();
  longer.sensors.push_back(hop.to);
  longer.error += hop.error;
  return longer;
}

}  // namespace

double edge_error(const PairwiseRegistration& edge) {
  const double inliers = static_cast<double>(std::max<std::size_t>(1, edge.inliers));
  const double lever = kLever / std::max(kMinSpread, edge.spread);
  return kEdgeFloor + edge.rms / std::sqrt(inliers) * std::sqrt(1.0 + lever * lever);
}

std::map<SensorId, Chain> best_chains(const SensorId& master,
                                      const std::vector<PairwiseRegistration>& edges) {
  std::map<SensorId, std::vector<Hop>> hops = hops_of(edges);
  std::map<SensorId, Chain> best;
  std::set<std::pair<double, SensorId>> open;
  best[master].sensors = {master};
  open.emplace(0.0, master);
  while (!open.empty()) {
    const SensorId sensor = open.begin()->second;
    open.erase(open.begin());
    const Chain chain = best[sensor];
    for (const Hop& hop : hops[sensor]) {
      const auto known = best.find(hop.to);
      const double error = chain.error + hop.error;
      if (known != best.end() && known->second.error <= error) continue;
      if (known != best.end()) open.erase({known->second.error, hop.to});
      best[hop.to] = extend(chain, hop);
      open.emplace(error, hop.to);
    }
  }
  return best;
}

const PairwiseRegistration* edge_between(const std::vector<PairwiseRegistration>& edges,
                                         const SensorId& a, const SensorId& b) {
  const auto found = std::find_if(edges.begin(), edges.end(), [&](const auto& edge) {
    return std::minmax(edge.target, edge.source) == std::minmax(a, b);
  });
  return found == edges.end() ? nullptr : &*found;
}

}  // namespace chorus::registration
