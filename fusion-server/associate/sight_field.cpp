#include "fusion-server/associate/sight_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/units.h"

namespace chorus::associate {
namespace {

// The usual view, less 2 degrees: at its edge half of the person is in the picture.
constexpr double kHalfWidth = deg(33.0), kHalfHeight = deg(28.0);  // [rad]
constexpr double kTooNear = 0.8, kTooFar = 4.4;                    // [m]
// Nobody is tracked farther off than this, and the record ends there.
constexpr double kEnd = 8.0;  // [m]

/// What is expected of a place before the sensor has a record there, and after how many seconds of
/// a record both count the same.
struct Expected {
  double chance, weight;
};
constexpr Expected kInside{0.9, 30.0};  // Half a minute without seeing anybody: something hides it.
constexpr Expected kOutside{0.1, 1.0};
constexpr float kMostRecord = 60.0F;  // [s]; a longer record fades, because furniture is moved.

bool is_ahead(const Eigen::Vector3d& place) {
  const double distance = place.norm();
  return place.z() > 0.0 && distance >= kTooNear && distance < kEnd;
}

Expected expected_at(const Eigen::Vector3d& place) {
  const double aside = std::atan2(std::abs(place.x()), place.z());
  const double upwards = std::atan2(std::abs(place.y()), std::hypot(place.x(), place.z()));
  const bool inside = aside <= kHalfWidth && upwards <= kHalfHeight && place.norm() <= kTooFar;
  return inside ? kInside : kOutside;
}

}  // namespace

std::size_t SightField::cell_of(const Eigen::Vector3d& place) {
  const double share = 0.5 + std::atan2(place.x(), place.z()) / std::numbers::pi;
  const double far = place.norm() / kEnd;
  const auto index = [](double part, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(part * static_cast<double>(count)));
  };
  return index(share, kAngles) * kDistances + index(far, kDistances);
}

double SightField::chance(const Eigen::Vector3d& place) const {
  if (!is_ahead(place)) return 0.0;
  const Expected before = expected_at(place);
  const Record& record = records_[cell_of(place)];
  return (before.chance * before.weight + record.seen) /
         (before.weight + record.seen + record.missed);
}

void SightField::learn(const Eigen::Vector3d& place, bool seen, double time) {
  if (!is_ahead(place) || !(time > 0.0)) return;
  Record& record = records_[cell_of(place)];
  (seen ? record.seen : record.missed) += static_cast<float>(time);
  const float sum = record.seen + record.missed;
  if (sum <= kMostRecord) return;
  record.seen *= kMostRecord / sum;
  record.missed *= kMostRecord / sum;
}

}  // namespace chorus::associate
