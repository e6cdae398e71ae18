#include "fusion-server/core/coverage.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;

// Two sensors saw somebody together if their frames were received within this time.
constexpr Duration kTogether = milliseconds(40);
constexpr double kCell = 0.5;             // [m]
constexpr double kNominalDistance = 3.0;  // [m]
constexpr std::size_t kMostCells = 400;   // per sensor, 10 x 10 m
// Common views per second, at the frame rate of most sensors.
constexpr double kRate = 30.0;

/// The neck of the only body; none if there are several, or if it is not seen.  On a ray it counts
/// as three metres away: enough to tell whether somebody walked.
std::optional<Eigen::Vector3d> neck_of(const SensorFrame& frame) {
  if (frame.bodies.size() != 1) return std::nullopt;
  const Joint& neck = frame.bodies.front().skeleton[JointId::Neck];
  if (!neck.given()) return std::nullopt;
  return neck.seen() ? neck.position : Eigen::Vector3d(kNominalDistance * neck.position);
}

int cell_of(double coordinate) { return static_cast<int>(std::floor(coordinate / kCell)); }

/// The sensors that are connected with `first` by pairs whose expected radius is within the target.
std::set<SensorId> linked_with(const SensorId& first, const std::vector<PairCoverage>& pairs,
                               double target) {
  std::set<SensorId> linked{first};
  for (std::size_t before = 0; before != linked.size();) {
    before = linked.size();
    for (const PairCoverage& pair : pairs) {
      if (pair.expected > target) continue;
      if (linked.contains(pair.first)) linked.insert(pair.second);
      if (linked.contains(pair.second)) linked.insert(pair.first);
    }
  }
  return linked;
}

const PairCoverage* best_between(const std::set<SensorId>& inside, const SensorId& outside,
                                 const std::vector<PairCoverage>& pairs) {
  const PairCoverage* best = nullptr;
  for (const PairCoverage& pair : pairs) {
    const bool links = (pair.first == outside && inside.contains(pair.second)) ||
                       (pair.second == outside && inside.contains(pair.first));
    if (links && (best == nullptr || pair.expected < best->expected)) best = &pair;
  }
  return best;
}

std::string advice_for(const SensorId& lonely, const PairCoverage* pair) {
  constexpr double kNarrow = 0.5;  // [m]; below this the rotation is badly determined
  if (pair == nullptr) {
    return fmt::format(
        "walk where {} and another sensor see you: it never saw you together with one",
        lonely.str());
  }
  if (pair->spread < kNarrow) {
    return fmt::format("walk farther about where {} and {} see you: all of it was within {:.1f} m",
                       pair->first.str(), pair->second.str(), pair->spread);
  }
  return fmt::format("walk on where {} and {} see you: they saw you together for {:.0f} s",
                     pair->first.str(), pair->second.str(),
                     static_cast<double>(pair->sightings) / kRate);
}

}  // namespace

void Coverage::clear() { *this = Coverage(); }

void Coverage::add(const SensorFrame& frame) {
  const auto neck = neck_of(frame);
  if (!neck) {
    newest_.erase(frame.sensor);
    return;
  }
  for (auto& [other, sight] : newest_) {
    if (other == frame.sensor || frame.received - sight.received > kTogether) continue;
    const bool first = frame.sensor < other;
    // A view of one sensor counts once for each other sensor: if the other sensor is faster, its
    // next frames do not count the view again.
    if (!first || !sight.counted.insert(frame.sensor).second) continue;
    Common& common = common_[{frame.sensor, other}];
    ++common.sightings;
    common.sum += *neck;
    common.squares += neck->squaredNorm();
    common.distance += 0.5 * (neck->norm() + sight.place.norm());
  }
  auto& cells = seen_[frame.sensor];
  const Cell cell{cell_of(neck->x()), cell_of(neck->z())};
  if (cells.size() < kMostCells || cells.contains(cell)) cells[cell] = *neck;
  newest_[frame.sensor] = {frame.received, *neck, {}};
}

std::vector<PairCoverage> Coverage::pairs() const {
  std::vector<PairCoverage> out;
  for (const auto& [names, common] : common_) {
    const double count = static_cast<double>(common.sightings);
    const double variance = common.squares / count - (common.sum / count).squaredNorm();
    const double spread = std::sqrt(std::max(0.0, variance));
    out.push_back({names.first, names.second, common.sightings, spread,
                   expected_radius(common.sightings, spread, common.distance / count)});
  }
  return out;
}

std::vector<CoveredCell> Coverage::cells(const Registration& registration) const {
  std::map<Cell, std::size_t> seen_by;
  for (const auto& [sensor, cells] : seen_) {
    const auto place = registration.sensors.find(sensor);
    if (place == registration.sensors.end()) continue;
    std::set<Cell> own;
    for (const auto& [cell, neck] : cells) {
      const Eigen::Vector3d in_world =
          place->second.world_from_sensor * (place->second.scale * neck);
      own.insert({cell_of(in_world.x()), cell_of(in_world.z())});
    }
    for (const Cell& cell : own) ++seen_by[cell];
  }
  std::vector<CoveredCell> out;
  for (const auto& [cell, sensors] : seen_by)
    out.push_back({kCell * (cell.first + 0.5), kCell * (cell.second + 0.5), sensors});
  return out;
}

double expected_radius(std::size_t sightings, double spread, double distance) {
  constexpr double kError = 0.010;    // error of one sensor, per axis [m]
  constexpr double kLasts = 0.8;      // [s]; errors within this time count as one
  constexpr double kBias = 0.010;     // error that no length of walk reduces [m]
  constexpr double kRadius95 = 2.45;  // 95 % radius in two dimensions [sigma]
  constexpr double kLeastSpread = 0.01;
  const double independent = std::max(1.0, static_cast<double>(sightings) / kRate / kLasts);
  const double lever = distance / std::max(spread, kLeastSpread);
  const double variance = 2.0 * kError * kError / independent * (2.0 + lever * lever);
  return kRadius95 * std::sqrt(variance + kBias * kBias);
}

std::vector<std::string> needs(const std::vector<PairCoverage>& pairs,
                               const std::set<SensorId>& seeing, double target) {
  std::vector<std::string> out;
  if (seeing.size() < 2) return out;
  // The largest group that is connected well enough; the other sensors have to be connected to it.
  std::set<SensorId> group;
  for (const SensorId& sensor : seeing) {
    auto linked = linked_with(sensor, pairs, target);
    if (linked.size() > group.size()) group = std::move(linked);
  }
  for (const SensorId& sensor : seeing) {
    if (!group.contains(sensor))
      out.push_back(advice_for(sensor, best_between(group, sensor, pairs)));
  }
  return out;
}

}  // namespace chorus::core
