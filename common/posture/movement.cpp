#include "common/posture/movement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/units.h"

namespace chorus::posture {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(600);
constexpr Duration kLeastStep = std::chrono::milliseconds(300);
constexpr Duration kGap = std::chrono::milliseconds(500);
constexpr double kHalfBand = deg(1.5);        // a band of 3 degrees
constexpr double kHalfBandDistance = mm(15);  // about what 3 degrees move a wrist by

double span_of(Timestamp from, Timestamp to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void Walk::add(Timestamp at, const Located& joints) {
  const auto& left = joints[chorus::index_of(JointId::HipLeft)];
  const auto& right = joints[chorus::index_of(JointId::HipRight)];
  if (!left || !right) return;
  if (!places_.empty() && (at - places_.back().at > kGap || at <= places_.back().at))
    places_.clear();
  const Eigen::Vector3d hips = 0.5 * (*left + *right);
  places_.push_back({at, {hips.x(), hips.z()}});
  while (at - places_.front().at > kStep) places_.pop_front();
}

std::optional<double> Walk::speed() const {
  if (places_.empty() || places_.back().at - places_.front().at < kLeastStep) return std::nullopt;
  return (places_.back().on_floor - places_.front().on_floor).norm() /
         span_of(places_.front().at, places_.back().at);
}

void Held::add(Timestamp at, const Measures& measures) {
  if (!window_.empty() && (at - window_.back().at > kGap || at <= window_.back().at))
    window_.clear();
  window_.push_back({at, measures});
  while (at - window_.front().at >= kOver) window_.pop_front();
}

Measures Held::median() const {
  Measures out;
  std::vector<double> known;
  known.reserve(window_.size());
  for (std::size_t m = 0; m < kMeasures; ++m) {
    known.clear();
    for (const Entry& entry : window_) {
      const double value = entry.measures.values[m];
      if (!std::isnan(value)) known.push_back(value);
    }
    if (known.empty() || 2 * known.size() < window_.size()) continue;
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    out.values[m] = *middle;
  }
  return out;
}

Measures Steady::follow(const Measures& measures) {
  for (std::size_t m = 0; m < kMeasures; ++m) {
    const double now = measures.values[m];
    double& shown = shown_.values[m];
    const double half = row_of(m).unit == Unit::Angle ? kHalfBand : kHalfBandDistance;
    shown = std::isnan(now) || std::isnan(shown) ? now : std::clamp(shown, now - half, now + half);
  }
  return shown_;
}

}  // namespace chorus::posture
