#include "fusion-server/core/hindsight.h"

#include <utility>

namespace chorus::core {
namespace {

constexpr std::size_t kMaxWaiting = 512;  // two seconds at 240 Hz

}  // namespace

Parts parts_of(const Snapshot& snapshot) {
  std::vector<double> counts(snapshot.sensors.size(), 0.0);
  double joints = 0.0;
  for (const FusedBody& body : snapshot.bodies) {
    for (const std::uint64_t contributors : body.contributors) {
      if (contributors == 0) continue;
      joints += 1.0;
      for (std::size_t i = 0; i < counts.size(); ++i)
        counts[i] += static_cast<double>((contributors >> i) & 1U);
    }
  }
  Parts parts;
  if (joints == 0.0) return parts;
  for (std::size_t i = 0; i < counts.size(); ++i) parts[snapshot.sensors[i]] = counts[i] / joints;
  return parts;
}

void Hindsight::remember(Answered answered) {
  if (answered.without.empty()) return;
  if (!waiting_.empty() && answered.tick.instant <= waiting_.back().tick.instant) forget();
  waiting_.push_back(std::move(answered));
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
}

std::optional<Answered> Hindsight::due(Timestamp now) {
  if (waiting_.empty()) return std::nullopt;
  const Answered& first = waiting_.front();
  if (now - first.tick.instant < delay_ + first.extension) return std::nullopt;
  Answered oldest = std::move(waiting_.front());
  waiting_.pop_front();
  return oldest;
}

}  // namespace chorus::core
