#include "common/body/hand_points.h"

#include <algorithm>
#include <utility>

namespace chorus {

HandsPtr shared(Hands hands) {
  if (!hands.left && !hands.right) return nullptr;
  return std::make_shared<const Hands>(std::move(hands));
}

std::optional<HandPoints> between(const std::optional<HandPoints>& a,
                                  const std::optional<HandPoints>& b, double s) {
  if (!a || !b) return std::nullopt;
  HandPoints out;
  for (std::size_t i = 0; i < kHandPoints; ++i)
    out.points[i] = (1.0 - s) * a->points[i] + s * b->points[i];
  if (a->variance && b->variance) out.variance = std::max(*a->variance, *b->variance);
  return out;
}

HandsPtr between(const HandsPtr& a, const HandsPtr& b, double s) {
  if (!a || !b) return nullptr;
  return shared({between(a->left, b->left, s), between(a->right, b->right, s)});
}

HandPoints moved(const Eigen::Isometry3d& b_from_a, HandPoints in_a) {
  for (Eigen::Vector3d& point : in_a.points) point = b_from_a * point;
  return in_a;
}

}  // namespace chorus
