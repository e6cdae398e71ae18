#include "fusion-server/fusion/handover.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace chorus::fusion {
namespace {

/// The views of one sensor; null: it had none.
struct Twice {
  const ViewPulls* now = nullptr;
  const ViewPulls* before = nullptr;
};

std::vector<Twice> matched(const std::vector<ViewPulls>& now,
                           const std::vector<ViewPulls>& before) {
  std::vector<Twice> sensors;
  for (const ViewPulls& view : now) sensors.push_back({&view, nullptr});
  for (const ViewPulls& view : before) {
    const auto same = std::ranges::find_if(sensors, [&](const Twice& each) {
      return each.now != nullptr && each.now->sensor == view.sensor;
    });
    if (same != sensors.end()) {
      same->before = &view;
    } else {
      sensors.push_back({nullptr, &view});
    }
  }
  return sensors;
}

/// How each view that stays has moved against the mean since an instant ago.
std::vector<Eigen::Vector3d> moved(std::size_t joint, const std::vector<Twice>& sensors) {
  std::vector<Eigen::Vector3d> all;
  for (const Twice& each : sensors) {
    if (each.now == nullptr || each.before == nullptr) continue;
    const Pull& now = each.now->joints[joint];
    const Pull& before = each.before->joints[joint];
    if (now.state == JointState::NotTracked || now.state != before.state) continue;
    all.push_back(now.off - before.off);
  }
  return all;
}

/// The movement of the joint since an instant ago according to the views that stay, minus that of
/// the mean over all views.  Added to the mean, it takes back the jump that the other views cause
/// by coming, by going, or by becoming or ceasing to be a guess.  Zero if all views stay, or none.
Eigen::Vector3d step_back(std::size_t joint, const std::vector<Twice>& sensors) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0.0;
  bool changed = false;
  for (const Twice& each : sensors) {
    const Pull now = each.now != nullptr ? each.now->joints[joint] : Pull{};
    const Pull before = each.before != nullptr ? each.before->joints[joint] : Pull{};
    if (now.state != before.state) {
      changed = true;
    } else {
      // A view that was an outlier, or is one now, has a small weight at one of both instants.  Its
      // way between them is not the joint's.
      const double weight = std::min(now.weight, before.weight);
      sum += weight * (now.off - before.off);
      weights += weight;
    }
  }
  if (!changed || !(weights > 0)) return Eigen::Vector3d::Zero();
  return sum / weights;
}

}  // namespace

void Handover::take(std::vector<ViewPulls> now, double passed, Duration fading) {
  const double kept = std::exp(-passed / seconds(fading));
  const std::vector<Twice> sensors = matched(now, before_);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    offsets_[j] = kept * (offsets_[j] + step_back(j, sensors));
    moved_[j] = moved(j, sensors);
  }
  before_ = std::move(now);
}

void Handover::hold_leap(std::size_t joint, const Eigen::Vector3d& mean,
                         const Eigen::Vector3d& expected, double farthest) {
  const Eigen::Vector3d leap = mean + offsets_[joint] - expected;
  const double distance = leap.norm();
  if (distance <= farthest || before_.size() < 2) return;
  const auto telling = std::ranges::count_if(moved_[joint], [&](const Eigen::Vector3d& against) {
    return (mean + against - expected).dot(leap) >= 0.5 * distance * distance;
  });
  if (telling < 2) offsets_[joint] -= (1.0 - farthest / distance) * leap;
}

}  // namespace chorus::fusion
