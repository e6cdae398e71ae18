// Finds the best chain of edges from the master to every other sensor (Otto 5.2.3, Fig. 11).
//
// The best chain has the smallest sum of edge errors (Dijkstra).  An edge may be followed in both
// directions; against its own direction its inverse is used.  Derived in
// docs/papers/registration.md, Section 7.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/flow/pairwise_registration.h"

namespace chorus::registration {

struct Chain {
  Eigen::Isometry3d master_from_sensor = Eigen::Isometry3d::Identity();
  std::vector<SensorId> sensors;  ///< Master first.
  double error = 0.0;             ///< Summed edge error [m].
  /// Covariance of (omega, tau) applied on the master side.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Contains reachable sensors only; the master has the identity, and itself as its chain.
[[nodiscard]] std::map<SensorId, Chain> best_chains(const SensorId& master,
                                                    const std::vector<PairwiseRegistration>& edges);

/// Cost of an edge in the graph [m]: rms / sqrt(inliers), larger for a narrow walk, plus a
/// constant, so that among equal chains the shorter one wins.
[[nodiscard]] double edge_error(const PairwiseRegistration& edge);

/// The edge of two sensors, in either direction; null if there is none.
[[nodiscard]] const PairwiseRegistration* edge_between(
    const std::vector<PairwiseRegistration>& edges, const SensorId& a, const SensorId& b);

}  // namespace chorus::registration
