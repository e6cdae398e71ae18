#include "common/resource/frame_shares.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace chorus::resource {
namespace {

bool is_whole(double sum, std::size_t count) {
  return std::abs(sum - 1.0) <= kShareTolerance * static_cast<double>(count);
}

}  // namespace

ShareList::ShareList(const std::vector<std::string>& sensors)
    : order_(std::min(sensors.size(), kMaxSensors)) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::ranges::sort(order_, {}, [&](std::size_t i) -> const std::string& { return sensors[i]; });
}

std::span<const double> ShareList::of(const Shares& shares, std::uint64_t contributors,
                                      Values& values) const {
  if (!shares.known()) return {};
  std::size_t count = 0;
  double sum = 0.0;
  for (const std::size_t i : order_) {
    if ((contributors >> i & 1U) == 0) continue;
    values[count] = shares.of(i);
    sum += values[count++];
  }
  // What readers would refuse is not written.
  if (count < 2 || !is_whole(sum, count)) return {};
  return std::span(values).first(count);
}

std::optional<Shares> ShareList::read(std::optional<std::span<const double>> list,
                                      std::uint64_t contributors) const {
  const auto count = static_cast<std::size_t>(std::popcount(contributors));
  ShareTally tally;
  if (!list) {
    if (count == 1) tally.add(contributors, 1.0);
    return tally.shares();
  }
  if (list->size() != count) return std::nullopt;
  double sum = 0.0;
  auto share = list->begin();
  for (const std::size_t i : order_) {
    if ((contributors >> i & 1U) == 0) continue;
    if (!(*share >= 0.0 && *share <= 1.0)) return std::nullopt;
    sum += *share;
    tally.add(std::uint64_t{1} << i, *share++);
  }
  if (!is_whole(sum, count)) return std::nullopt;
  return tally.shares();
}

}  // namespace chorus::resource
