#include "fusion-server/core/closure.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/geometry/rotation.h"
#include "fusion-server/registration/transform_graph.h"

namespace chorus::core {
namespace {

using EdgeMap = std::map<std::pair<SensorId, SensorId>, const PairwiseRegistration*>;

/// A point in front of a sensor, where people walk: at the best distance by Otto Eq. (1).
const Eigen::Vector3d kWalk(0.0, 0.0, 2.5);

/// a_from_b according to the edge between the two; none if there is no such edge.
std::optional<Eigen::Isometry3d> between(const EdgeMap& edges, const SensorId& a,
                                         const SensorId& b) {
  if (const auto found = edges.find({a, b}); found != edges.end())
    return found->second->target_from_source;
  if (const auto found = edges.find({b, a}); found != edges.end())
    return found->second->target_from_source.inverse();
  return std::nullopt;
}

/// Notes how far the worst loop through one other sensor is from closing.
void note_loops(PairwiseRegistration& edge, const EdgeMap& edges,
                const Registration& registration) {
  edge.loop.reset();
  edge.loop_turn.reset();
  for (const auto& [third, place] : registration.sensors) {
    const auto there = between(edges, edge.target, third);
    const auto back = between(edges, third, edge.source);
    if (!there || !back) continue;
    const Eigen::Isometry3d around = *there * *back;
    const double gap = (around * kWalk - edge.target_from_source * kWalk).norm();
    const double turn = angular_distance(Eigen::Quaterniond(around.linear()),
                                         Eigen::Quaterniond(edge.target_from_source.linear()));
    edge.loop = std::max(edge.loop.value_or(0.0), gap);
    edge.loop_turn = std::max(edge.loop_turn.value_or(0.0), turn);
  }
}

/// Notes the best chain that reaches the sensor by another last edge than the chosen chain.
void note_next_chain(Registration& registration, const SensorId& sensor, Extrinsics& place) {
  place.next_chain.clear();
  if (place.chain.size() < 2) return;
  const SensorId& chosen = place.chain[place.chain.size() - 2];
  double least = std::numeric_limits<double>::infinity();
  for (const PairwiseRegistration& edge : registration.edges) {
    if (edge.target != sensor && edge.source != sensor) continue;
    const SensorId& neighbour = edge.target == sensor ? edge.source : edge.target;
    const auto other = registration.sensors.find(neighbour);
    if (neighbour == chosen || other == registration.sensors.end()) continue;
    const Extrinsics& through = other->second;
    const double error = through.error + registration::edge_error(edge);
    if (error >= least || std::ranges::find(through.chain, sensor) != through.chain.end()) continue;
    least = place.next_error = error;
    place.next_chain = through.chain;
    place.next_chain.push_back(sensor);
  }
}

}  // namespace

void note_closure(Registration& registration) {
  EdgeMap edges;
  for (const PairwiseRegistration& edge : registration.edges)
    edges[{edge.target, edge.source}] = &edge;
  for (PairwiseRegistration& edge : registration.edges) {
    note_loops(edge, edges, registration);
    edge.apart.reset();
    const auto target = registration.sensors.find(edge.target);
    const auto source = registration.sensors.find(edge.source);
    if (target == registration.sensors.end() || source == registration.sensors.end()) continue;
    const Eigen::Isometry3d together =
        target->second.world_from_sensor.inverse() * source->second.world_from_sensor;
    edge.apart = (together * kWalk - edge.target_from_source * kWalk).norm();
  }
  for (auto& [sensor, place] : registration.sensors) note_next_chain(registration, sensor, place);
}

}  // namespace chorus::core
