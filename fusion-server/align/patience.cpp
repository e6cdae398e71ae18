#include "fusion-server/align/patience.h"

#include <algorithm>
#include <vector>

namespace chorus::align {

Patience::Patience(const std::map<SensorId, const History*>& histories, const AlignConfig& config)
    : config_(config), common_(config.patience) {
  std::vector<Duration> waits;
  for (const auto& [sensor, history] : histories) {
    if (const auto wait = usual_wait(*history)) waits.push_back(*wait);
  }
  if (waits.empty()) return;
  const auto middle = waits.begin() + static_cast<std::ptrdiff_t>((waits.size() - 1) / 2);
  std::nth_element(waits.begin(), middle, waits.end());
  common_ = std::min(common_, *middle);
}

AlignConfig Patience::of(const History& history) const {
  AlignConfig own = config_;
  const auto& habit = history.habit();
  const bool steady = habit && habit->most_delay - habit->least_delay <= config_.unsteady;
  if (habit && !steady) own.patience = std::min(own.patience, common_);
  return own;
}

}  // namespace chorus::align
