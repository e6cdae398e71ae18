#include "fusion-server/align/patience.h"

#include <algorithm>
#include <vector>

namespace chorus::align {
namespace {

constexpr int kWorse = 2;  // times the spread of the middle sensor

/// The lower one of two.
Duration middle_of(std::vector<Duration>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Patience::Patience(const std::map<SensorId, const History*>& histories, const AlignConfig& config)
    : config_(config), common_(config.patience), steady_(config.unsteady) {
  std::vector<Duration> waits;
  std::vector<Duration> spreads;
  for (const auto& [sensor, history] : histories) {
    if (!history->habit()) continue;
    waits.push_back(*usual_wait(*history));
    spreads.push_back(history->habit()->spread());
  }
  if (waits.empty()) return;
  common_ = std::min(common_, middle_of(waits));
  steady_ = std::max(steady_, kWorse * middle_of(spreads));
}

AlignConfig Patience::of(const History& history) const {
  AlignConfig own = config_;
  const auto& habit = history.habit();
  if (habit && habit->spread() > steady_) own.patience = std::min(own.patience, common_);
  return own;
}

}  // namespace chorus::align
