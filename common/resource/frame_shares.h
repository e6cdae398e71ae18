// Internal to common/resource: the sensors' shares in a joint, as a list on the wire.
//
// RDF does not keep the order of a joint's contributors, so the list is in the order of their ids
// (bytes compared).  It is left out where there are fewer than two contributors: one has all.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/sensor/limits.h"
#include "common/sensor/shares.h"

namespace chorus::resource {

inline constexpr int kShareDecimals = 2;
/// By how much the sum of a list may differ from 1, times the number of its shares.
inline constexpr double kShareTolerance = 0.01;

/// Most bytes that one share of a list and what surrounds it take.
inline constexpr std::size_t kShareBytes = 10;

/// For one frame.
class ShareList {
 public:
  using Values = std::array<double, kMaxSensors>;

  /// `sensors`: the frame's, whose indices are those of the contributors' bits.
  explicit ShareList(const std::vector<std::string>& sensors);

  /// The list that is written for a joint, a part of `values`; empty if no list is written.
  [[nodiscard]] std::span<const double> of(const Shares& shares, std::uint64_t contributors,
                                           Values& values) const;
  /// The shares that a joint's list stands for; `list` may be missing.  Nothing if the list does
  /// not hold one share from 0 to 1 for each contributor, or if the shares do not add up to 1.
  [[nodiscard]] std::optional<Shares> read(std::optional<std::span<const double>> list,
                                           std::uint64_t contributors) const;

 private:
  [[nodiscard]] Shares in_proportion(std::span<const double> list,
                                     std::uint64_t contributors) const;

  std::vector<std::size_t> order_;  ///< Indices of the sensors, by id.
};

}  // namespace chorus::resource
