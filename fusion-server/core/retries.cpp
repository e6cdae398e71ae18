#include "fusion-server/core/retries.h"

#include <algorithm>

namespace chorus::core {
namespace {

constexpr Duration kFirstRetry = std::chrono::seconds(30);
constexpr int kMaxDoublings = 5;  // at most 16 minutes
constexpr Duration kAfterCancel = std::chrono::seconds(60);

}  // namespace

void Retries::failed(const SensorId& sensor, Timestamp now) {
  Retry& retry = sensors_[sensor];
  retry.not_before = now + kFirstRetry * (1 << std::min(retry.failures, kMaxDoublings));
  ++retry.failures;
}

void Retries::cancelled(Timestamp now) { not_before_ = now + kAfterCancel; }

void Retries::keep(const std::set<SensorId>& sensors) {
  std::erase_if(sensors_, [&](const auto& entry) { return !sensors.contains(entry.first); });
}

void Retries::clear() {
  sensors_.clear();
  not_before_ = Timestamp{};
}

std::optional<Timestamp> Retries::waits(const SensorId& sensor, Timestamp now) const {
  const auto retry = sensors_.find(sensor);
  if (retry == sensors_.end() || now >= retry->second.not_before) return std::nullopt;
  return retry->second.not_before;
}

}  // namespace chorus::core
