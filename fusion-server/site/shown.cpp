#include "fusion-server/site/shown.h"

#include <algorithm>

#include "common/base/square.h"

namespace chorus::site {
namespace {

/// Nobody is moved on for longer; what is older is shown where it is then.
constexpr Duration kLongestLag = std::chrono::milliseconds(500);
/// People who walk change their speed by some 3 m/s^2, and what is told is 0.1 s old.
constexpr double kSpeedDoubt = 0.3;  // [m/s]
/// A body that was not shown for this long is no longer being followed by anybody's eye.
constexpr Duration kContinued = std::chrono::milliseconds(200);
/// Two cells that agree worse are wrong about more than places: a path from one to the other would
/// be made up.
constexpr double kMostBlended = 0.5;  // [m]
constexpr std::size_t kPelvis = index_of(JointId::SpineBase);

double lag_of(const SitePerson& person, Timestamp at) {
  return seconds(std::clamp(at - person.at, -kLongestLag, kLongestLag));
}

/// Moved on to the instant, without any blend.
ShownPerson moved_on(const SitePerson& person, Timestamp at) {
  const double lag = lag_of(person, at);
  ShownPerson shown{person, {}, person.cell_covariance};
  shown.moved.fill(lag * person.velocity);
  shown.doubt += square(kSpeedDoubt * lag) * Eigen::Matrix3d::Identity();
  return shown;
}

}  // namespace

Eigen::Vector3d ShownPerson::place() const { return told.place + moved[kPelvis]; }

/// Another cell answers for the person from now on.
void Showing::begin(Last& last, const ShownPerson& person, Timestamp at) const {
  last.blends = false;
  const Duration since = at - last.at;
  if (since < Duration{0} || since > kContinued || blend_ <= Duration{0}) return;
  const Eigen::Vector3d on = seconds(since) * last.velocity;
  const Eigen::Vector3d off = last.place + on - person.place();
  if (!(off.norm() <= kMostBlended)) return;
  last.blends = true;
  last.begin = at;
  // A joint that only one of the cells tells goes with the pelvis.
  last.off.fill(off);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (last.joints[i] && person.told.joints[i])
      last.off[i] = *last.joints[i] + on - *person.told.joints[i] - person.moved[i];
  }
}

double Showing::left(const Last& last, Timestamp at) const {
  if (!last.blends) return 0.0;
  const double u = std::clamp(seconds(at - last.begin) / seconds(blend_), 0.0, 1.0);
  return 1.0 - u * u * (3.0 - 2.0 * u);
}

std::vector<ShownPerson> Showing::show(std::span<const SitePerson> people, Timestamp at) {
  std::vector<ShownPerson> all;
  for (const SitePerson& person : people) {
    ShownPerson shown = moved_on(person, at);
    const auto [found, fresh] = last_.try_emplace(person.id);
    Last& last = found->second;
    if (!fresh && last.cell != person.cell) begin(last, shown, at);
    const double share = left(last, at);
    if (share > 0.0) {
      for (std::size_t i = 0; i < kJointCount; ++i) shown.moved[i] += share * last.off[i];
      const Eigen::Vector3d off = share * last.off[kPelvis];
      shown.doubt += off * off.transpose();
    }
    last.cell = person.cell;
    last.at = at;
    last.place = shown.place();
    last.velocity = person.velocity;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      last.joints[i] = person.joints[i];
      if (last.joints[i]) *last.joints[i] += shown.moved[i];
    }
    all.push_back(std::move(shown));
  }
  std::erase_if(last_, [at](const auto& each) { return each.second.at != at; });
  return all;
}

}  // namespace chorus::site
