#include "fusion-server/site/trail.h"

#include <algorithm>

namespace chorus::site {
namespace {

// Longer than the evidence for a pair and the longest delay between cells together.
constexpr Duration kKept = std::chrono::milliseconds(2500);
constexpr Duration kLongestHole = std::chrono::milliseconds(200);

}  // namespace

void Trail::add(const Sample& sample) {
  if (!samples_.empty() && sample.at <= samples_.back().at) return;
  samples_.push_back(sample);
  while (sample.at - samples_.front().at > kKept) samples_.pop_front();
}

std::optional<Sample> Trail::at(Timestamp instant) const {
  const auto after = std::ranges::lower_bound(samples_, instant, {}, &Sample::at);
  if (after == samples_.end()) return std::nullopt;
  if (after->at == instant) return *after;
  if (after == samples_.begin()) return std::nullopt;
  const Sample& before = *std::prev(after);
  if (after->at - before.at > kLongestHole) return std::nullopt;
  const double share = seconds(instant - before.at) / seconds(after->at - before.at);
  Sample between{instant};
  between.place = before.place + share * (after->place - before.place);
  between.velocity = before.velocity + share * (after->velocity - before.velocity);
  between.covariance = before.covariance + share * (after->covariance - before.covariance);
  return between;
}

}  // namespace chorus::site
