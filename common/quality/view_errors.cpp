#include "common/quality/view_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

#include <Eigen/Dense>

namespace chorus::quality {
namespace {

constexpr std::size_t kMostSensors = 64;
constexpr std::size_t kFewestSteps = 100;
constexpr double kFarthest = 0.5;  // [m]; a view farther off is of something else
constexpr double kRidge = 1e-9;    // of the equations' size: a sensor without views has variance 0

using Views = std::span<const ViewResidual>;

auto place_of(const ViewResidual& view) { return std::tuple(view.person, view.joint, view.sensor); }
auto joint_of(const ViewResidual& view) { return std::pair(view.person, view.joint); }

/// Least squares for v in  v_i + v_k = value.
class PairSums {
 public:
  void add(std::size_t one, std::size_t two, double value) {
    const auto i = static_cast<Eigen::Index>(one);
    const auto k = static_cast<Eigen::Index>(two);
    squares_(i, i) += 1.0;
    squares_(k, k) += 1.0;
    squares_(i, k) += 1.0;
    squares_(k, i) += 1.0;
    values_[i] += value;
    values_[k] += value;
    ++rows_;
  }
  /// Zero for sensors without views.
  [[nodiscard]] Eigen::VectorXd solve() const {
    if (rows_ == 0) return Eigen::VectorXd::Zero(values_.size());
    Eigen::MatrixXd squares = squares_;
    squares.diagonal().array() += kRidge * static_cast<double>(rows_);
    return squares.ldlt().solve(values_);
  }

 private:
  Eigen::MatrixXd squares_ = Eigen::MatrixXd::Zero(kMostSensors, kMostSensors);
  Eigen::VectorXd values_ = Eigen::VectorXd::Zero(kMostSensors);
  std::size_t rows_ = 0;
};

struct Mean {
  double sum = 0.0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double value() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

/// E[(r(t) - r(t-1))^2] over S of a filter of gain g; falls from 2 to 0.
double change_of(double g) {
  return (1.0 - g) * (1.0 - g) * (1.0 + (1.0 + g) * (1.0 + g) + g * g * g / (2.0 - g));
}

double gain_of(double change) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double g = 0.5 * (low + high);
    (change_of(g) > change ? low : high) = g;
  }
  return 0.5 * (low + high);
}

Eigen::Vector3d weighted_mean(Views views) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double shares = 0.0;
  for (const ViewResidual& view : views) {
    sum += view.share * view.off;
    shares += view.share;
  }
  return sum / shares;
}

/// The views of one step, each of its place once, without those that are of something else.
std::vector<ViewResidual> in_order(const std::vector<ViewResidual>& step) {
  std::vector<ViewResidual> views;
  for (const ViewResidual& view : step)
    if (view.sensor < kMostSensors && view.joint < kJointCount && view.off.norm() < kFarthest &&
        view.share > 0.0)
      views.push_back(view);
  std::ranges::stable_sort(views, {}, place_of);
  std::vector<ViewResidual> last;
  for (const ViewResidual& view : views) {
    if (!last.empty() && place_of(last.back()) == place_of(view))
      last.back() = view;
    else
      last.push_back(view);
  }
  return last;
}

bool same_sensors(Views one, Views two) {
  return std::ranges::equal(one, two, {}, &ViewResidual::sensor, &ViewResidual::sensor);
}

}  // namespace

struct ViewErrors::OfJoint {
  PairSums whole;                                                        ///< s + l
  PairSums lasting;                                                      ///< l
  Eigen::VectorXd squared_shares = Eigen::VectorXd::Zero(kMostSensors);  ///< Summed over steps.
  Mean residual;                                                         ///< r^2 per axis
  Mean change;  ///< (r(t) - r(t-1))^2 per axis
  Mean stated;

  void add(Views views, Views before);
  [[nodiscard]] std::optional<double> variance() const;
};

void ViewErrors::OfJoint::add(Views views, Views before) {
  double shares = 0.0;
  for (const ViewResidual& view : views) shares += view.share;
  for (const ViewResidual& view : views)
    squared_shares[static_cast<Eigen::Index>(view.sensor)] += std::pow(view.share / shares, 2);
  const Eigen::Vector3d r = weighted_mean(views);
  residual.add(r.squaredNorm() / 3.0);
  if (views.front().stated > 0.0) stated.add(views.front().stated);
  const bool followed = same_sensors(views, before);
  if (followed) change.add((r - weighted_mean(before)).squaredNorm() / 3.0);
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t k = i + 1; k < views.size(); ++k) {
      const Eigen::Vector3d d = views[i].off - views[k].off;
      whole.add(views[i].sensor, views[k].sensor, d.squaredNorm() / 3.0);
      if (followed)
        lasting.add(views[i].sensor, views[k].sensor, d.dot(before[i].off - before[k].off) / 3.0);
    }
}

std::optional<double> ViewErrors::OfJoint::variance() const {
  if (residual.count < kFewestSteps || change.count < kFewestSteps) return std::nullopt;
  const Eigen::VectorXd shares = squared_shares / static_cast<double>(residual.count);
  const double all = shares.dot(whole.solve());
  const double lasts = std::clamp(shares.dot(lasting.solve()), 0.0, std::max(0.0, all));
  const double fresh = all - lasts;
  const double gain = fresh > 0.0 ? gain_of(change.value() / fresh) : 1.0;
  const double found = residual.value() - all + 2.0 * (gain * fresh + lasts);
  if (!std::isfinite(found)) return std::nullopt;
  return std::max(0.0, found);
}

ViewErrors::ViewErrors() = default;
ViewErrors::~ViewErrors() = default;
ViewErrors::ViewErrors(ViewErrors&&) noexcept = default;
ViewErrors& ViewErrors::operator=(ViewErrors&&) noexcept = default;

void ViewErrors::add(const std::vector<ViewResidual>& step) {
  std::vector<ViewResidual> views = in_order(step);
  for (std::size_t from = 0; from < views.size();) {
    std::size_t to = from + 1;
    while (to < views.size() && joint_of(views[to]) == joint_of(views[from])) ++to;
    if (to - from >= 2) {
      auto& joint = joints_[views[from].joint];
      if (!joint) joint = std::make_unique<OfJoint>();
      const auto before = std::ranges::equal_range(before_, joint_of(views[from]), {}, joint_of);
      joint->add(Views(views).subspan(from, to - from), Views(before));
    }
    from = to;
  }
  before_ = std::move(views);
}

std::array<ViewError, kJointCount> ViewErrors::finish() const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::array<ViewError, kJointCount> out;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    out[j] = {kNone, kNone};
    if (!joints_[j]) continue;
    if (joints_[j]->stated.count > 0) out[j].stated = std::sqrt(joints_[j]->stated.value());
    if (const auto variance = joints_[j]->variance()) out[j].found = std::sqrt(*variance);
  }
  return out;
}

}  // namespace chorus::quality
