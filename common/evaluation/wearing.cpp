#include "common/evaluation/wearing.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "common/evaluation/time_shift.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

constexpr double kNoFit = std::numbers::pi;  // residual of what cannot be fitted

double residual_of(const TrackedLimb& limb, const OrientationTrack& sensor,
                   const CalibrateOptions& options) {
  const auto fit = fit_calibration(pairs_of(limb, sensor), options);
  return fit ? fit->calibration.residual : kNoFit;
}

/// One round of successive shortest paths: gives row `row` a column.  Index 0 is "none".
struct Potentials {
  std::vector<double> of_row, of_column;
  std::vector<std::size_t> row_at, way;
};

void place(const std::vector<std::vector<double>>& cost, std::size_t row, Potentials& p) {
  const std::size_t columns = p.of_column.size() - 1;
  std::vector<double> least(columns + 1, std::numeric_limits<double>::infinity());
  std::vector<char> used(columns + 1, 0);
  std::size_t at = 0;
  p.row_at[0] = row;
  while (p.row_at[at] != 0) {
    used[at] = 1;
    std::size_t next = 0;
    double delta = std::numeric_limits<double>::infinity();
    for (std::size_t j = 1; j <= columns; ++j) {
      if (used[j] != 0) continue;
      const double reduced =
          cost[p.row_at[at] - 1][j - 1] - p.of_row[p.row_at[at]] - p.of_column[j];
      if (reduced < least[j]) least[j] = reduced, p.way[j] = at;
      if (least[j] < delta) delta = least[j], next = j;
    }
    for (std::size_t j = 0; j <= columns; ++j) {
      if (used[j] != 0)
        p.of_row[p.row_at[j]] += delta, p.of_column[j] -= delta;
      else
        least[j] -= delta;
    }
    at = next;
  }
  for (; at != 0; at = p.way[at]) p.row_at[at] = p.row_at[p.way[at]];
}

std::string undecided(const WornSensor& a, const WornSensor& b, Limb on_a, Limb on_b) {
  return fmt::format("sensors {} and {} could be exchanged ({} and {}); to decide, {}", a.name,
                     b.name, words_for(on_a), words_for(on_b), movement_for(on_a));
}

}  // namespace

OrientationPairs pairs_of(const TrackedLimb& limb, const OrientationTrack& sensor) {
  OrientationPairs out;
  for (const auto& each : limb) {
    const auto sensed = orientation_at(sensor, each.time);
    if (sensed) out.push_back({each.time, each.value, *sensed});
  }
  return out;
}

std::vector<std::size_t> least_cost(const std::vector<std::vector<double>>& cost) {
  const std::size_t rows = cost.size();
  const std::size_t columns = rows > 0 ? cost.front().size() : 0;
  if (rows == 0 || rows > columns) return {};
  Potentials p{std::vector<double>(rows + 1, 0.0), std::vector<double>(columns + 1, 0.0),
               std::vector<std::size_t>(columns + 1, 0), std::vector<std::size_t>(columns + 1, 0)};
  for (std::size_t row = 1; row <= rows; ++row) place(cost, row, p);
  std::vector<std::size_t> out(rows, 0);
  for (std::size_t j = 1; j <= columns; ++j)
    if (p.row_at[j] != 0) out[p.row_at[j] - 1] = j - 1;
  return out;
}

Result<std::vector<Limb>> worn_on(const std::vector<WornSensor>& sensors, const TrackedBody& body,
                                  const WearingOptions& options) {
  std::vector<Limb> limbs;
  for (const auto& [limb, track] : body) limbs.push_back(limb);
  if (sensors.empty() || sensors.size() > limbs.size())
    return fail(ErrorCode::InvalidArgument, "sensors",
                fmt::format("there are {}, and the tracker shows {} limbs; name their limbs",
                            sensors.size(), limbs.size()));
  std::vector<std::vector<double>> cost;
  for (const WornSensor& sensor : sensors) {
    auto& row = cost.emplace_back();
    for (const Limb limb : limbs)
      row.push_back(residual_of(body.at(limb), sensor.track, options.calibrate));
  }
  const std::vector<std::size_t> found = least_cost(cost);
  for (std::size_t a = 0; a < sensors.size(); ++a) {
    for (std::size_t b = a + 1; b < sensors.size(); ++b) {
      const double margin =
          cost[a][found[b]] + cost[b][found[a]] - cost[a][found[a]] - cost[b][found[b]];
      if (margin >= options.least_margin) continue;
      return fail(ErrorCode::Conflict, "sensors",
                  undecided(sensors[a], sensors[b], limbs[found[a]], limbs[found[b]]));
    }
  }
  std::vector<Limb> out;
  for (const std::size_t column : found) out.push_back(limbs[column]);
  return out;
}

Result<std::size_t> worn_by(const std::vector<WornSensor>& sensors, const std::vector<Limb>& limbs,
                            const std::vector<TrackedBody>& people, const WearingOptions& options) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t person = 0; person < people.size(); ++person) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < std::min(sensors.size(), limbs.size()); ++i) {
      const auto limb = people[person].find(limbs[i]);
      sum += limb == people[person].end()
                 ? kNoFit
                 : residual_of(limb->second, sensors[i].track, options.calibrate);
      count += 1.0;
    }
    if (count > 0) order.emplace_back(sum / count, person);
  }
  std::ranges::sort(order);
  if (order.empty())
    return fail(ErrorCode::InvalidArgument, "people", "there is nobody to choose from");
  // Standing still fits everybody: what is compared must be more than the limbs' own noise.
  const double least = std::max(order.front().first, options.calibrate.least_sigma);
  if (order.size() == 1 || order[1].first >= options.least_ratio * least)
    return order.front().second;
  return fail(ErrorCode::Conflict, "people",
              "the sensors fit two people alike; whoever wears them should walk and turn");
}

}  // namespace chorus::evaluation
