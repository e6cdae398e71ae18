#include "fusion-server/worn/heading.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::worn {
namespace {

constexpr double kLeastTurn = deg(5);  // of the sensor between two instants that count
constexpr double kAlike = 0.4;         // [s] within which a tracker's errors are alike
constexpr double kFarthest = deg(45);  // of an instant that can be about the heading alone
constexpr double kDoubtful = deg(12);  // beyond which an instant counts less and less
constexpr double kLeastTelling = deg(60);

}  // namespace

std::optional<HeadingSight> heading_sight(const evaluation::TrackedOrientation& tracked,
                                          const Eigen::Quaterniond& predicted, double skin) {
  const Eigen::Matrix3d axes = tracked.world_from_limb.toRotationMatrix();
  Eigen::Vector3d error = log_map(tracked.world_from_limb * predicted.conjugate());
  Eigen::Vector3d information;
  for (int k = 0; k < 3; ++k)
    information(k) = 1.0 / (skin * skin + std::max(0.0, tracked.covariance(k, k)));
  if (!tracked.twist_seen) {
    const Eigen::Vector3d along = axes.col(1);
    const Eigen::Vector3d y = predicted * Eigen::Vector3d::UnitY();
    error = log_map(Eigen::Quaterniond::FromTwoVectors(y, along));
    information.y() = 0.0;
  }
  if (!error.allFinite() || !information.allFinite()) return std::nullopt;
  const Eigen::Matrix3d weight = axes * information.asDiagonal() * axes.transpose();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  const double known = up.dot(weight * up);
  if (!(known > 1.0 / (kLeastTelling * kLeastTelling))) return std::nullopt;
  return HeadingSight{up.dot(weight * error) / known, 1.0 / known};
}

double Heading::variance(double time) const {
  return variance_ + (begun_ ? walk_ * walk_ * std::max(0.0, time - *begun_) : 0.0);
}

void Heading::learn(double time, const Eigen::Quaterniond& inertial_from_sensor,
                    const HeadingSight& sight) {
  if (!begun_) begun_ = time;
  const bool first = !last_;
  const bool turned = !first && angular_distance(turned_, inertial_from_sensor) >= kLeastTurn;
  if (!first && !turned) return;
  const double passed = first ? 0.0 : std::clamp(time - *last_, 0.0, kAlike);
  last_ = time;
  turned_ = inertial_from_sensor;
  if (!(passed > 0.0) || !(std::abs(sight.off) < kFarthest)) return;
  const double beyond = std::max(1.0, std::abs(sight.off) / kDoubtful);
  const double noise = sight.variance * kAlike / passed * beyond * beyond;
  const double before = variance(time);
  const double gain = before / (before + noise);
  correction_ = wrap_angle(correction_ + gain * sight.off);
  variance_ = (1.0 - gain) * before;
  begun_ = time;
}

}  // namespace chorus::worn
