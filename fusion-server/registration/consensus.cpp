#include "fusion-server/registration/consensus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::registration {
namespace {

constexpr double kLeastLoop = 0.15;  // [m] a triangle counts as closed up to this error
constexpr double kLoopOfRms = 2.0;   // ... or up to this multiple of its edges' residuals
constexpr double kLoopTurn = deg(15);
constexpr double kSameRms = 1e-4;    // [m] two different sensors do not agree this closely
constexpr double kSamePlace = 1e-3;  // [m], [rad]

bool of(const SensorId& sensor, const SensorId& target, const SensorId& source) {
  return sensor == target || sensor == source;
}

/// The transform to the sensor `to` from the other end of the edge, whichever way it was estimated.
Eigen::Isometry3d along(const PairwiseRegistration& edge, const SensorId& to) {
  return edge.target == to ? edge.target_from_source : edge.target_from_source.inverse();
}

/// Finds the edge between two sensors, whichever of them is its target.
class EdgeIndex {
 public:
  explicit EdgeIndex(const Evidence& evidence) {
    for (const PairwiseRegistration& edge : evidence.edges)
      edges_.emplace(std::minmax(edge.target, edge.source), &edge);
  }

  [[nodiscard]] const PairwiseRegistration* between(const SensorId& a, const SensorId& b) const {
    const auto found = edges_.find(std::minmax(a, b));
    return found == edges_.end() ? nullptr : found->second;
  }
  /// The sensors with a greater id than `sensor` with which it has edges, in ascending order.
  [[nodiscard]] std::vector<SensorId> after(const SensorId& sensor) const {
    std::vector<SensorId> others;
    for (auto at = edges_.lower_bound({sensor, {}}); at != edges_.end(); ++at) {
      if (at->first.first != sensor) break;
      others.push_back(at->first.second);
    }
    return others;
  }

 private:
  std::map<std::pair<SensorId, SensorId>, const PairwiseRegistration*> edges_;
};

std::set<SensorId> sensors_of(const Evidence& evidence) {
  std::set<SensorId> all;
  for (const PairwiseRegistration& edge : evidence.edges) all.insert({edge.target, edge.source});
  for (const Contradiction& each : evidence.contradictions) all.insert({each.target, each.source});
  return all;
}

/// The evidence for and against one sensor.
struct Standing {
  int credit = 0;
  int blame = 0;
  double misfit = 0.0;  ///< Sum over its edges of residual / share of pairs that agree [m].
  std::set<SensorId> accusers;
  double widest = 0.0;  ///< Largest loop error [m]; infinite if a loop turns its sensors.

  [[nodiscard]] int excess() const { return blame - credit; }
};

using Standings = std::map<SensorId, Standing>;

void count_pairs(const Evidence& evidence, Standings& standings) {
  for (const PairwiseRegistration& edge : evidence.edges) {
    const double share = static_cast<double>(std::max<std::size_t>(1, edge.inliers)) /
                         static_cast<double>(std::max<std::size_t>(1, edge.pairs));
    for (const SensorId& each : {edge.target, edge.source}) {
      ++standings[each].credit;
      standings[each].misfit += edge.rms / share;
    }
  }
  for (const Contradiction& each : evidence.contradictions) {
    ++standings[each.target].blame;
    ++standings[each.source].blame;
    standings[each.target].accusers.insert(each.source);
    standings[each.source].accusers.insert(each.target);
  }
}

void count_triangle(const std::array<SensorId, 3>& corners, const Evidence& evidence,
                    const EdgeIndex& edges, Standings& standings) {
  const PairwiseRegistration* ab = edges.between(corners[0], corners[1]);
  const PairwiseRegistration* bc = edges.between(corners[1], corners[2]);
  const PairwiseRegistration* ca = edges.between(corners[2], corners[0]);
  if (ab == nullptr || bc == nullptr || ca == nullptr) return;
  const double off = loop_error(*ab, *bc, *ca, evidence);
  const bool closed = off <= std::max(kLeastLoop, kLoopOfRms * (ab->rms + bc->rms + ca->rms));
  for (const SensorId& each : corners) {
    Standing& standing = standings[each];
    ++(closed ? standing.credit : standing.blame);
    if (closed) continue;
    standing.widest = std::max(standing.widest, off);
    for (const SensorId& other : corners) {
      if (other != each) standing.accusers.insert(other);
    }
  }
}

Standings standings_of(const Evidence& evidence) {
  Standings standings;
  count_pairs(evidence, standings);
  const EdgeIndex edges(evidence);
  for (const SensorId& a : sensors_of(evidence)) {
    const std::vector<SensorId> others = edges.after(a);
    for (auto b = others.begin(); b != others.end(); ++b) {
      for (auto c = std::next(b); c != others.end(); ++c)
        count_triangle({a, *b, *c}, evidence, edges, standings);
    }
  }
  return standings;
}

/// The sensor with the worst evidence; of equal ones, the one whose pairs fit worst. None if every
/// sensor has more evidence for it than against it, and all triangles are closed.
std::optional<SensorId> worst_of(const Standings& standings) {
  const auto key = [](const Standing& standing) {
    const bool convicted = standing.blame > 0 && (standing.excess() >= 0 || standing.widest > 0.0);
    return std::tuple(convicted, standing.excess(), standing.misfit / std::max(1, standing.credit));
  };
  const auto worst = std::ranges::max_element(
      standings, [&](const auto& a, const auto& b) { return key(a.second) < key(b.second); });
  if (worst == standings.end()) return std::nullopt;
  if (!std::get<0>(key(worst->second))) return std::nullopt;
  return worst->first;
}

void remove(Evidence& evidence, const SensorId& sensor) {
  std::erase_if(evidence.edges, [&](const PairwiseRegistration& edge) {
    return of(sensor, edge.target, edge.source);
  });
  std::erase_if(evidence.contradictions,
                [&](const Contradiction& each) { return of(sensor, each.target, each.source); });
}

std::string reason_for(const SensorId& sensor, const Standing& standing) {
  std::vector<std::string> accusers;
  for (const SensorId& each : standing.accusers) accusers.push_back(each.str());
  const std::string by = std::isfinite(standing.widest) && standing.widest > 0.0
                             ? fmt::format(", who place it {:.2f} m apart", standing.widest)
                             : std::string();
  return fmt::format(
      "sensor {}{}{}{}: it followed somebody else, is mirrored, or its clock is wrong; "
      "walk alone",
      sensor.str(), kContradicts, fmt::join(accusers, ", "), by);
}

/// A sensor that reports the same numbers as another, that is, a copy; none if there is none.
std::optional<Outcast> copy_among(const Evidence& evidence) {
  for (const PairwiseRegistration& edge : evidence.edges) {
    const double off = edge.target_from_source.translation().norm() +
                       angular_distance(Eigen::Quaterniond(edge.target_from_source.linear()),
                                        Eigen::Quaterniond::Identity());
    if (edge.rms > kSameRms || off > kSamePlace) continue;
    const auto [first, second] = std::minmax(edge.target, edge.source);
    return Outcast{second, fmt::format("sensor {} reports exactly what {} reports: one of them "
                                       "repeats the other",
                                       second.str(), first.str())};
  }
  return std::nullopt;
}

}  // namespace

double loop_error(const PairwiseRegistration& ab, const PairwiseRegistration& bc,
                  const PairwiseRegistration& ca, const Evidence& evidence) {
  const SensorId a = of(ab.target, ca.target, ca.source) ? ab.target : ab.source;
  const SensorId b = ab.target == a ? ab.source : ab.target;
  const SensorId c = ca.target == a ? ca.source : ca.target;
  const Eigen::Isometry3d around = along(ab, a) * along(bc, b) * along(ca, c);
  const double turn =
      angular_distance(Eigen::Quaterniond(around.linear()), Eigen::Quaterniond::Identity());
  if (turn > kLoopTurn) return std::numeric_limits<double>::infinity();
  const auto middle = evidence.middles.find(a);
  const Eigen::Vector3d x =
      middle == evidence.middles.end() ? Eigen::Vector3d::Zero() : middle->second;
  return (around * x - x).norm();
}

std::vector<Outcast> cast_out(Evidence& evidence) {
  std::vector<Outcast> outcasts;
  while (const auto copy = copy_among(evidence)) {
    outcasts.push_back(*copy);
    remove(evidence, copy->sensor);
  }
  while (sensors_of(evidence).size() > 2) {
    const Standings standings = standings_of(evidence);
    const auto worst = worst_of(standings);
    if (!worst) break;
    Evidence rest = evidence;
    remove(rest, *worst);
    if (rest.edges.empty()) break;
    outcasts.push_back({*worst, reason_for(*worst, standings.at(*worst))});
    evidence = std::move(rest);
  }
  return outcasts;
}

}  // namespace chorus::registration
