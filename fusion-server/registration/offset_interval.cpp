#include "fusion-server/registration/offset_interval.h"

#include <algorithm>
#include <cmath>

namespace chorus::registration {
namespace {

constexpr double kChi95 = 3.841;      // chi^2 with one degree of freedom at 95 %
constexpr double kNear = 0.060;       // [s] offsets this close to the best belong to its mode
constexpr double kSurelyWorse = 1.0;  // standard deviations
using Series = std::vector<Eigen::Vector3d>;

double mean_of(const std::vector<Loss>& losses) {
  double sum = 0.0;
  for (const Loss& loss : losses) sum += loss.value;
  return sum / static_cast<double>(losses.size());
}

/// The profile: -2 log L at every offset, assuming as many independent frames as at the best one.
class Profile {
 public:
  explicit Profile(const std::vector<OffsetFit>& fits) : fits_(fits) {
    for (const OffsetFit& fit : fits) costs_.push_back(mean_of(fit.walk.losses));
    best_ = static_cast<std::size_t>(std::ranges::min_element(costs_) - costs_.begin());
    const StudentFit& walk = fits[best_].walk;
    const double independent = static_cast<double>(walk.losses.size()) / walk.inflation;
    for (double& cost : costs_) cost *= independent;
  }

  [[nodiscard]] std::size_t best() const { return best_; }

  [[nodiscard]] bool excluded(std::size_t i) const {
    if (costs_[i] - costs_[best_] - between_steps() <= kChi95) return false;
    const bool near = std::abs(fits_[i].offset - fits_[best_].offset) <= kNear;
    return near || surely_worse(fits_[i]);
  }

  /// Where the parabola through the best offset and its neighbours has its minimum.
  [[nodiscard]] double vertex() const {
    const double at_best = fits_[best_].offset;
    if (at_rim() || !(bend() > 0.0)) return at_best;
    const double step = fits_[best_ + 1].offset - at_best;
    return at_best + 0.5 * (costs_[best_ - 1] - costs_[best_ + 1]) / bend() * step;
  }

 private:
  [[nodiscard]] bool at_rim() const { return best_ == 0 || best_ + 1 == costs_.size(); }
  [[nodiscard]] double bend() const {
    return costs_[best_ - 1] - 2.0 * costs_[best_] + costs_[best_ + 1];
  }
  /// How much lower the cost may be between two searched offsets than at the best of them: half a
  /// step from its minimum, a parabola has risen by a quarter of what it rises in a whole step.
  [[nodiscard]] double between_steps() const { return at_rim() ? 0.0 : 0.125 * bend(); }

  /// Differences of the losses over the frames that both offsets have.
  [[nodiscard]] Series differences(const OffsetFit& fit) const {
    const std::vector<Loss>& there = fits_[best_].walk.losses;
    auto other = there.begin();
    Series series;
    for (const Loss& loss : fit.walk.losses) {
      while (other != there.end() && other->frame < loss.frame) ++other;
      if (other == there.end()) break;
      if (other->frame == loss.frame) series.emplace_back(loss.value - other->value, 0.0, 0.0);
    }
    return series;
  }

  [[nodiscard]] bool surely_worse(const OffsetFit& fit) const {
    Series series = differences(fit);
    if (series.empty()) return false;
    const double count = static_cast<double>(series.size());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& each : series) mean += each / count;
    double squares = 0.0;
    for (Eigen::Vector3d& each : series) {
      each -= mean;
      squares += each.squaredNorm();
    }
    const double deviation = std::sqrt(squares * inflation_of(series)) / count;
    return mean.x() > kSurelyWorse * deviation;
  }

  const std::vector<OffsetFit>& fits_;
  std::vector<double> costs_;
  std::size_t best_ = 0;
};

}  // namespace

OffsetInterval interval_of(const std::vector<OffsetFit>& fits) {
  const Profile profile(fits);
  OffsetInterval interval{profile.vertex(), fits[profile.best()].offset,
                          fits[profile.best()].offset};
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (profile.excluded(i)) continue;
    interval.low = std::min(interval.low, fits[i].offset);
    interval.high = std::max(interval.high, fits[i].offset);
  }
  return interval;
}

}  // namespace chorus::registration
