#include "fusion-server/align/patience.h"

#include <algorithm>

namespace chorus::align {
namespace {

constexpr int kWorse = 2;  // A sensor with more than this many times the median spread is unsteady.
/// Number of cameras without depth that are needed for a body.
constexpr std::size_t kCameras = 2;

/// Factor between slowness and patience; it allows for differences between sensors and frames.
constexpr int kSlack = 2;

/// The inherent slowness of a sensor: its period plus its least delay.  A busy computer, which
/// delays all frames, does not change this.
Duration slowness(const History& history) {
  return history.period().value_or(Duration{0}) + history.habit()->least_delay;
}

/// Index, in order of slowness, of the slowest sensor for which the patience must suffice: the
/// median, or for an even count the faster of the two in the middle. If no sensor has depth it is
/// at least the second, because one camera alone does not yield a body.
std::size_t middle(std::size_t count, bool rays) {
  const std::size_t least = rays ? std::min(count, kCameras) - 1 : 0;
  return std::max((count - 1) / 2, least);
}

Duration at_place(std::vector<Duration>& values, std::size_t place) {
  const auto found = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), found, values.end());
  return *found;
}

}  // namespace

Patience::Patience(const std::map<SensorId, const History*>& histories, const AlignConfig& config)
    : config_(config),
      patience_(config.patience),
      common_(config.patience),
      steady_(config.unsteady) {
  std::vector<Duration> slow;
  std::vector<Duration> waits;
  std::vector<Duration> spreads;
  bool rays = true;
  for (const auto& [sensor, history] : histories) {
    if (!history->habit()) continue;
    slow.push_back(slowness(*history));
    waits.push_back(*usual_wait(*history));
    spreads.push_back(history->habit()->spread());
    rays = rays && history->rays_only();
  }
  if (waits.empty()) return;
  const std::size_t place = middle(waits.size(), rays);
  patience_ = std::max(patience_, std::min(kSlack * at_place(slow, place), config.slowest));
  common_ = std::min(patience_, at_place(waits, place));
  steady_ = std::max(steady_, kWorse * at_place(spreads, place));
  all_needed_ = rays && waits.size() <= kCameras;
}

AlignConfig Patience::of(const History& history) const {
  AlignConfig own = config_;
  own.patience = patience_;
  const auto& habit = history.habit();
  if (!habit || all_needed_) return own;
  // A slow sensor's pictures queue, so its delay naturally varies by about half a period.
  const Duration steady = std::max(steady_, history.period().value_or(Duration{0}) / 2);
  if (habit->spread() > steady) own.patience = std::min(own.patience, common_);
  return own;
}

}  // namespace chorus::align
