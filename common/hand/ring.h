// Indices around a closed outline.
#pragma once

#include <cstddef>
#include <limits>

#include "common/hand/hand.h"

namespace chorus::hand {

/// The index of the best point on the way from `from` to `to`, both included, clockwise; `value`
/// says how good a point is.
template <class Value>
[[nodiscard]] std::size_t best_between(const Outline& outline, std::size_t from, std::size_t to,
                                       Value value) {
  const std::size_t n = outline.points.size();
  std::size_t best = from;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = from;; i = (i + 1) % n) {
    const double v = value(outline.points[i]);
    if (v > most) most = v, best = i;
    if (i == to) return best;
  }
}

/// Steps from `from` to `to`, clockwise.
[[nodiscard]] inline std::size_t steps(const Outline& outline, std::size_t from, std::size_t to) {
  const std::size_t n = outline.points.size();
  return (to + n - from) % n;
}

[[nodiscard]] inline std::size_t nearest_index(const Outline& outline, const Pixel& at) {
  return best_between(outline, 0, outline.points.size() - 1,
                      [&](const Pixel& p) { return -(p - at).squaredNorm(); });
}

/// The first point, from `tip` on in steps of `step` (+1 or -1), that is as far from the tip as
/// `length`: the other end of a finger's base whose web is known.
[[nodiscard]] inline std::size_t opposite_base(const Outline& outline, std::size_t tip,
                                               double length, int step) {
  const std::size_t n = outline.points.size();
  const std::size_t forward = step > 0 ? 1 : n - 1;
  std::size_t i = tip;
  for (std::size_t k = 0; k < n; ++k, i = (i + forward) % n) {
    if ((outline.points[i] - outline.points[tip]).norm() >= length) return i;
  }
  return tip;
}

[[nodiscard]] inline bool on_border(const Outline& outline, const Pixel& p) {
  constexpr double kNear = 2.0;
  return p.x() < kNear || p.y() < kNear || p.x() > outline.width - 1 - kNear ||
         p.y() > outline.height - 1 - kNear;
}

}  // namespace chorus::hand
