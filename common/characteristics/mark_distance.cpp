#include "common/characteristics/mark_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::characteristics {
namespace {

constexpr std::size_t kSectors = 12;        // of 30 deg, over the whole circle
constexpr std::size_t kLeastSectors = 9;    // with fewer, bias and circle are hard to tell apart
constexpr std::size_t kFewestInSector = 5;  // sights
constexpr std::array kSpine{JointId::SpineBase, JointId::SpineMid, JointId::SpineShoulder,
                            JointId::Neck};
constexpr double kFull = 2 * std::numbers::pi;

/// Mean shortfall of one joint in each sector [m].
struct Shortfall {
  std::array<double, kSectors> sum{};
  std::array<std::size_t, kSectors> count{};

  [[nodiscard]] bool known(std::size_t i) const { return count[i] >= kFewestInSector; }
  [[nodiscard]] double mean(std::size_t i) const { return sum[i] / static_cast<double>(count[i]); }
  [[nodiscard]] std::size_t sectors() const {
    std::size_t all = 0;
    for (std::size_t i = 0; i < kSectors; ++i) all += known(i) ? 1 : 0;
    return all;
  }
};

double middle_of(std::size_t sector) {
  return (static_cast<double>(sector) + 0.5) * kFull / static_cast<double>(kSectors);
}

Shortfall shortfall_of(JointId id, double distance, const OnePerson& person,
                       const std::vector<Stance>& stances) {
  Shortfall shortfall;
  for (std::size_t i = 0; i < stances.size(); ++i) {
    const Sight& sight = person.sights[i];
    const Joint& joint = sight.body[id];
    if (!stances[i].angle || !sight.standing || joint.state != JointState::Tracked) continue;
    if (!joint.seen()) continue;
    const double turn = std::fmod(std::fmod(*stances[i].angle, kFull) + kFull, kFull);
    const auto sector = std::min(
        kSectors - 1, static_cast<std::size_t>(turn / kFull * static_cast<double>(kSectors)));
    const double level = std::hypot(joint.position.x(), joint.position.z());
    // Converts the horizontal shortfall to one along the line of sight, which is longer.
    shortfall.sum[sector] += (distance - level) * joint.position.norm() / std::max(level, 1e-3);
    ++shortfall.count[sector];
  }
  return shortfall;
}

/// The bias of one joint: over all sectors, and in each of them.
struct JointBias {
  double bias = 0.0;
  std::array<double, kSectors> by_sector{};  ///< Mean shortfall without the circle [m].
};

JointBias fit(const Shortfall& shortfall) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < kSectors; ++i) {
    if (!shortfall.known(i)) continue;
    const Eigen::Vector3d row(1.0, std::cos(middle_of(i)), std::sin(middle_of(i)));
    normal += row * row.transpose();
    right += row * shortfall.mean(i);
  }
  const Eigen::Vector3d found = normal.ldlt().solve(right);
  JointBias joint{found[0], {}};
  for (std::size_t i = 0; i < kSectors; ++i) {
    if (!shortfall.known(i)) continue;
    joint.by_sector[i] =
        shortfall.mean(i) - found[1] * std::cos(middle_of(i)) - found[2] * std::sin(middle_of(i));
  }
  return joint;
}

/// Values and their mean.
struct Spread {
  double sum = 0.0, squares = 0.0, count = 0.0;
  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0.0; }
  /// Standard deviation of the mean.
  [[nodiscard]] double error() const {
    if (count < 2) return 0.0;
    return std::sqrt(std::max(0.0, (squares - sum * sum / count) / (count - 1)) / count);
  }
};

Spread& part_of(std::array<Spread, 3>& parts, std::size_t sector) {
  const double away = away_from_sensor(middle_of(sector));
  return parts.at(away < deg(60) ? 0 : away < deg(120) ? 1 : 2);
}

}  // namespace

Result<MarkedDepthBias> depth_bias_by(const Mark& mark, const OnePerson& person,
                                      const std::vector<Stance>& stances) {
  if (!person.has_floor)
    return fail(ErrorCode::InvalidArgument, person.sensor.str(),
                "states no floor plane, so that a distance along the floor cannot be compared with "
                "its own: give the plane when importing (--floor)");
  Spread joints;
  std::array<Spread, 3> parts;
  for (const JointId id : kSpine) {
    const Shortfall shortfall = shortfall_of(id, mark.distance, person, stances);
    if (shortfall.sectors() < kLeastSectors) continue;
    const JointBias joint = fit(shortfall);
    joints.add(joint.bias);
    for (std::size_t i = 0; i < kSectors; ++i) {
      if (!shortfall.known(i)) continue;
      part_of(parts, i).add(joint.by_sector[i]);
    }
  }
  if (joints.count < 2)
    return fail(ErrorCode::InvalidArgument, person.sensor.str(),
                "did not see the person from all sides: stay on the mark and turn once, within 20 "
                "to 60 s");
  Spread sides;
  for (const Spread& part : parts) {
    if (part.count > 0) sides.add(part.mean());
  }
  const double sigma = std::hypot(joints.error(), sides.error());
  return MarkedDepthBias{{joints.mean(), std::hypot(mark.sigma, sigma)},
                         parts[0].mean(),
                         parts[1].mean(),
                         parts[2].mean()};
}

}  // namespace chorus::characteristics
