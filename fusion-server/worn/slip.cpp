#include "fusion-server/worn/slip.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/median.h"

namespace chorus::worn {
namespace {

constexpr double kLookEvery = 0.1;   // [s]
constexpr double kSlipWindow = 2.0;  // [s] of looks that the median is over
constexpr double kLasts = 1.2;       // [s] for which it must be beyond
constexpr std::size_t kLeastLooks = 10;
constexpr double kLargestGap = 10.0;  // [s] after which earlier looks say nothing
constexpr double kTimesUsual = 3.0;
constexpr double kUsualTime = 20.0;  // [s] over which the limb's usual wander is averaged

double middle_of(std::vector<double> values) {
  return values.empty() ? 0.0 : median(std::move(values));
}

}  // namespace

double SlipWatch::median_size() const {
  std::vector<double> x, y, z;
  for (const Look& look : looks_) {
    x.push_back(look.error.x());
    z.push_back(look.error.z());
    if (look.twist_seen) y.push_back(look.error.y());
  }
  const bool twists = y.size() >= kLeastLooks;
  return Eigen::Vector3d(middle_of(std::move(x)), twists ? middle_of(std::move(y)) : 0.0,
                         middle_of(std::move(z)))
      .norm();
}

void SlipWatch::learn(double time, const Eigen::Vector3d& error, bool twist_seen) {
  if (!error.allFinite()) return;
  if (!looks_.empty() && time - looks_.back().time < kLookEvery) return;
  if (!looks_.empty() && time - looks_.back().time > kLargestGap) looks_.clear();
  looks_.push_back({time, error, twist_seen});
  // Looks, not seconds: a limb that is seen now and then takes longer.
  while (looks_.size() > static_cast<std::size_t>(kSlipWindow / kLookEvery)) looks_.pop_front();
  if (looks_.size() < kLeastLooks) return;
  turned_ = median_size();
  const double usual = std::max(usual_, weight_ > 0.0 ? wander_ : 0.0);
  if (turned_ > least_ + kTimesUsual * usual) {
    if (!beyond_since_) beyond_since_ = time;
    if (time - *beyond_since_ >= kLasts) slipped_ = turned_;
    return;
  }
  beyond_since_.reset();
  weight_ = std::exp(-kLookEvery / kUsualTime) * weight_ + kLookEvery;
  wander_ += kLookEvery / weight_ * (turned_ - wander_);
}

}  // namespace chorus::worn
