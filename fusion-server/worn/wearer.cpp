#include "fusion-server/worn/wearer.h"

#include <algorithm>
#include <numbers>

#include "common/evaluation/calibrate.h"
#include "common/geometry/rotation.h"

namespace chorus::worn {
namespace {

constexpr double kTakeEvery = 0.1;       // [s]
constexpr double kSearchSpan = 10.0;     // [s] of pairs that are kept
constexpr double kLeastSearch = 2.0;     // [s] before the first fit
constexpr double kFreshFit = 2.0;        // [s] within which a fit counts
constexpr std::size_t kMostTelling = 4;  // sensors that are fitted
constexpr std::size_t kSearchPairs = 60;
constexpr double kLeastSwing = deg(25);  // of a sensor that tells anything
constexpr double kLeastFloor = deg(3);   // what fits leave over at best
constexpr double kClearRatio = 1.5;      // the next person must fit worse by this
constexpr double kFits = deg(12);        // the wearer must fit as well as this
constexpr double kFitsAlone = deg(8);    // and this where there is nobody else to compare with

/// How far a sensor has turned from where it was at first.
double swing_of(const evaluation::OrientationPairs& pairs) {
  double most = 0.0;
  for (const auto& pair : pairs)
    most = std::max(
        most, angular_distance(pairs.front().inertial_from_sensor, pair.inertial_from_sensor));
  return most;
}

}  // namespace

void WearerSearch::take(double time, const std::vector<Beside>& all) {
  for (const Beside& each : all) {
    seen_[each.person] = time;
    auto& pairs = trials_[{each.person, each.sensor}].pairs;
    if (!pairs.empty() && time < pairs.back().time) pairs.clear();
    if (!pairs.empty() && time - pairs.back().time < kTakeEvery) continue;
    pairs.push_back(each.pair);
    std::erase_if(pairs, [&](const auto& pair) { return time - pair.time > kSearchSpan; });
  }
  const auto gone = [&](PersonId person) {
    const auto seen = seen_.find(person);
    return seen == seen_.end() || time - seen->second > kLeastSearch;
  };
  std::erase_if(trials_, [&](const auto& entry) { return gone(entry.first.first); });
  std::erase_if(seen_, [&](const auto& entry) { return time - entry.second > kLeastSearch; });
}

/// The sensors that have turned most, each far enough.
std::vector<std::string> WearerSearch::telling() const {
  std::map<std::string, double> swings;
  for (const auto& [key, trial] : trials_)
    swings[key.second] = std::max(swings[key.second], swing_of(trial.pairs));
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [sensor, swing] : swings)
    if (swing >= kLeastSwing) order.emplace_back(-swing, sensor);
  std::ranges::sort(order);
  if (order.size() > kMostTelling) order.resize(kMostTelling);
  std::vector<std::string> names;
  for (auto& [swing, sensor] : order) names.push_back(std::move(sensor));
  return names;
}

void WearerSearch::fit_stalest(double time, const std::vector<std::string>& sensors) {
  Trial* stalest = nullptr;
  for (auto& [key, trial] : trials_) {
    if (std::ranges::find(sensors, key.second) == sensors.end()) continue;
    if (stalest == nullptr || trial.fitted < stalest->fitted) stalest = &trial;
  }
  if (stalest == nullptr) return;
  stalest->fitted = time;
  evaluation::CalibrateOptions options;
  options.most_pairs = kSearchPairs;
  const bool enough = !stalest->pairs.empty() &&
                      stalest->pairs.back().time - stalest->pairs.front().time >= kLeastSearch;
  const auto fit = evaluation::fit_calibration(stalest->pairs, options);
  stalest->residual.reset();
  if (enough && fit) stalest->residual = fit->calibration.residual;
}

std::optional<PersonId> WearerSearch::decided(double time,
                                              const std::vector<std::string>& sensors) {
  std::vector<std::pair<double, PersonId>> order;
  for (const auto& [person, seen] : seen_) {
    double sum = 0.0;
    for (const std::string& sensor : sensors) {
      const auto trial = trials_.find({person, sensor});
      const bool fitted = trial != trials_.end() && time - trial->second.fitted <= kFreshFit;
      if (trial != trials_.end() && !fitted) return std::nullopt;
      sum += fitted ? trial->second.residual.value_or(std::numbers::pi) : std::numbers::pi;
    }
    order.emplace_back(sum / static_cast<double>(sensors.size()), person);
  }
  std::ranges::sort(order);
  if (order.empty()) return std::nullopt;
  const double best = order.front().first;
  const bool alone = order.size() == 1;
  if (best > (alone ? kFitsAlone : kFits)) {
    reason_ = "nobody who is seen moves like it; whoever wears it should walk where they are seen";
    return std::nullopt;
  }
  if (!alone && order[1].first < kClearRatio * std::max(best, kLeastFloor)) {
    reason_ = "two people move alike; whoever wears it should walk and turn alone";
    return std::nullopt;
  }
  return order.front().second;
}

std::optional<PersonId> WearerSearch::look(double time) {
  const std::vector<std::string> sensors = telling();
  if (sensors.size() < 2) {
    reason_ = trials_.empty() ? "nobody is seen with it yet"
                              : "its sensors are still; whoever wears it should walk and turn";
    return std::nullopt;
  }
  fit_stalest(time, sensors);
  return decided(time, sensors);
}

}  // namespace chorus::worn
