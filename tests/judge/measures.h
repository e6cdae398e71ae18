// Constants and helpers that several scores share.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "common/body/bones.h"
#include "common/body/skeleton.h"

namespace chorus::bench {

inline constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kRest = 0.03;  ///< [m/s] a slower joint is at rest

/// The lower ends of upper arms, forearms, thighs and shanks.
inline constexpr std::array kLongBones{JointId::ElbowLeft, JointId::WristLeft,  JointId::KneeLeft,
                                       JointId::AnkleLeft, JointId::ElbowRight, JointId::WristRight,
                                       JointId::KneeRight, JointId::AnkleRight};

struct Mean {
  double sum = 0.0;
  std::size_t count = 0;

  void add(double value) {
    sum += value;
    ++count;
  }
  /// kNothing without values.
  [[nodiscard]] double value() const {
    return count > 0 ? sum / static_cast<double>(count) : kNothing;
  }
};

/// The length of the bone that ends in `child` [m]; none when one of its ends was not seen.
[[nodiscard]] inline std::optional<double> length_of(const Skeleton<WorldSpace>& body,
                                                     JointId child) {
  const JointId parent = parent_of(child);
  if (!body[child].seen() || !body[parent].seen()) return std::nullopt;
  return (body[child].position - body[parent].position).norm();
}

}  // namespace chorus::bench
