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

/// What the product of two decimals may be off by.
constexpr double kRounding = 1e-9;

Shares all_of(std::uint64_t sensor) {
  Shares::Hundredths hundredths{};
  hundredths[static_cast<std::size_t>(std::countr_zero(sensor))] = Shares::kHundredths;
  return Shares(hundredths);
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
  if (!list) return count == 1 ? all_of(contributors) : Shares();
  if (list->size() != count) return std::nullopt;
  Shares::Hundredths hundredths{};
  unsigned whole = 0;
  bool exact = true;
  double sum = 0.0;
  auto share = list->begin();
  for (const std::size_t i : order_) {
    if ((contributors >> i & 1U) == 0) continue;
    if (!(*share >= 0.0 && *share <= 1.0)) return std::nullopt;
    sum += *share;
    const double scaled = *share++ * Shares::kHundredths;
    hundredths[i] = static_cast<std::uint8_t>(scaled + 0.5);
    whole += hundredths[i];
    exact = exact && std::abs(scaled - hundredths[i]) < kRounding;
  }
  if (exact && whole == Shares::kHundredths) return Shares(hundredths);
  if (!is_whole(sum, count)) return std::nullopt;
  return in_proportion(*list, contributors);
}

/// Shares from a list by another writer, which may have more decimals or not quite add up to 1.
Shares ShareList::in_proportion(std::span<const double> list, std::uint64_t contributors) const {
  ShareTally tally;
  auto share = list.begin();
  for (const std::size_t i : order_) {
    if ((contributors >> i & 1U) != 0) tally.add(std::uint64_t{1} << i, *share++);
  }
  return tally.shares();
}

}  // namespace chorus::resource
