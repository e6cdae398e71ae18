#include "fusion-server/watch/watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace chorus::watch {
namespace {

using std::chrono::milliseconds;

constexpr Duration kEvery = milliseconds(90);    // successive frames have nearly the same errors
constexpr Duration kBlock = milliseconds(500);   // length of a block
constexpr Duration kStale = milliseconds(1500);  // a block that takes longer is given up
constexpr std::size_t kLeast = 3;                // fewest residuals in a block
constexpr Duration kBreak = milliseconds(400);   // after a gap longer than this, a person is new
constexpr double kSmoothing = 0.5;               // [s]
constexpr double kWalking = 0.25;                // [m/s]
/// The largest shift must exceed the others by this factor, because a moved sensor also shifts the
/// mean with which the other sensors are compared.
constexpr double kClearly = 1.3;

Block block_of(const std::vector<Residual>& residuals, Timestamp began) {
  Block block;
  block.begin = began;
  for (const Residual& each : residuals) {
    block.apart += each.apart;
    block.rows += rows_of(each);
    block.others.insert(each.others.begin(), each.others.end());
  }
  block.apart /= static_cast<double>(residuals.size());
  block.rows /= static_cast<double>(residuals.size());
  return block;
}

std::vector<Eigen::Vector3d> middles_but_of(const Person& person,
                                            const std::vector<Person>& people) {
  std::vector<Eigen::Vector3d> middles;
  for (const Person& other : people) {
    const auto middle = other.carried ? other.carried : middle_of(other);
    if (other.id != person.id && middle) middles.push_back(*middle);
  }
  return middles;
}

}  // namespace

void Watch::look(const std::vector<Person>& people, Timestamp instant, const WatchConfig& config) {
  config_ = config;
  if (!config.enabled) return sensors_.clear();
  if (instant > last_ && instant - last_ < kEvery) return;
  last_ = instant;
  for (const Person& person : people) {
    if (person.carried || !walks(person, instant)) continue;
    const Person clearly = seen_clearly(person, middles_but_of(person, people));
    for (Residual& residual : residuals_of(clearly)) add(std::move(residual), instant);
  }
  std::erase_if(walkers_, [&](const auto& e) { return instant - e.second.seen > kBreak; });
}

bool Watch::walks(const Person& person, Timestamp instant) {
  const auto middle = middle_of(person);
  if (!middle) return false;
  auto [entry, fresh] = walkers_.try_emplace(person.id, Walker{*middle, instant});
  Walker& walker = entry->second;
  const Duration passed = instant - walker.seen;
  if (fresh || passed <= Duration{0} || passed > kBreak) {
    walker = {*middle, instant};
    return false;
  }
  // A person at constant speed v is v * kSmoothing ahead of their smoothed position.
  Eigen::Vector3d ahead = *middle - walker.smoothed;
  walker.smoothed += (1.0 - std::exp(-seconds(passed) / kSmoothing)) * ahead;
  walker.seen = instant;
  ahead.y() = 0.0;
  return ahead.norm() > kWalking * kSmoothing;
}

void Watch::add(Residual residual, Timestamp instant) {
  Watched& sensor = sensors_[residual.sensor];
  const Duration open_for = instant - sensor.began;  // negative: the clock was set back
  if (open_for < Duration{0} || open_for > kStale) sensor.open.clear();
  if (!sensor.open.empty() && instant - sensor.began >= kBlock && sensor.open.size() >= kLeast)
    close(sensor);
  if (sensor.open.empty()) sensor.began = instant;
  sensor.open.push_back(std::move(residual));
}

void Watch::close(Watched& sensor) {
  sensor.recent.push_back(block_of(sensor.open, sensor.began));
  sensor.open.clear();
  if (sensor.recent.size() > kWindow) {
    if (!is_moved(sensor)) sensor.usual.learn(sensor.recent.front());
    sensor.recent.pop_front();
  }
  judge(sensor);
}

void Watch::judge(Watched& sensor) const {
  sensor.shift = sensor.test.test(sensor.recent, sensor.usual, config_.least_sigmas);
  const Rows& rows = sensor.recent.back().rows;
  const Eigen::Vector3d off = sensor.usual.of_place(rows);
  const Eigen::Matrix3d spread = sensor.usual.uncertainty_of_place(rows);
  const double sigmas = std::sqrt(std::max(0.0, off.dot(spread.ldlt().solve(off))));
  sensor.drift = sigmas >= config_.least_sigmas ? off.norm() : 0.0;
}

bool Watch::is_moved(const Watched& sensor) const {
  return sensor.shift.sigmas >= config_.least_sigmas &&
         sensor.shift.middle.norm() >= config_.least_shift;
}

/// The sensor's shift or drift [m]; zero unless the sensor counts as moved or drifted.
double Watch::size_of(const Watched& sensor) const {
  if (sensor.recent.empty()) return 0.0;
  if (is_moved(sensor)) return sensor.shift.middle.norm();
  return sensor.drift >= config_.least_drift ? sensor.drift : 0.0;
}

std::optional<Finding> Watch::finding() const {
  const Watched* worst = nullptr;
  Finding found;
  double next = 0.0;
  for (const auto& [id, sensor] : sensors_) {
    const double size = size_of(sensor);
    if (size <= found.shift) {
      next = std::max(next, size);
      continue;
    }
    next = std::max(next, found.shift);
    found.sensor = id;
    found.shift = size;
    worst = &sensor;
  }
  if (worst == nullptr) return std::nullopt;
  found.drifted = !is_moved(*worst);
  found.since = found.drifted ? last_ : worst->shift.since;
  const auto& others = found.drifted ? worst->recent.back().others : worst->shift.others;
  if (others.size() == 1) {
    found.or_else = *others.begin();
    return found;
  }
  if (next * kClearly > found.shift) return std::nullopt;  // wait until one stands out
  return found;
}

std::optional<double> Watch::shift_of(const SensorId& sensor) const {
  const auto own = sensors_.find(sensor);
  if (own == sensors_.end() || own->second.recent.size() < kWindow) return std::nullopt;
  return own->second.shift.middle.norm();
}

void Watch::forget() { sensors_.clear(); }

}  // namespace chorus::watch
