#include "common/quality/view_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

namespace chorus::quality {
namespace {

constexpr std::size_t kMostSensors = 64;
constexpr std::size_t kFewestSteps = 100;
constexpr double kFarthest = 0.5;  // [m]; a view farther off is of something else

using Views = std::span<const ViewResidual>;

auto place_of(const ViewResidual& view) { return std::tuple(view.person, view.joint, view.sensor); }
auto joint_of(const ViewResidual& view) { return std::pair(view.person, view.joint); }

struct Mean {
  double sum = 0.0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double value() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

Eigen::Vector3d weighted_mean(Views views) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double shares = 0.0;
  for (const ViewResidual& view : views) {
    sum += view.share * view.off;
    shares += view.share;
  }
  return sum / shares;
}

/// M, per axis, by this instant.
double variance_of_mean(Views views) {
  double sum = 0.0;
  double shares = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    shares += views[i].share;
    for (std::size_t k = i + 1; k < views.size(); ++k)
      sum += views[i].share * views[k].share * (views[i].off - views[k].off).squaredNorm();
  }
  return sum / (3.0 * shares * shares * static_cast<double>(views.size() - 1));
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
  Mean mean;      ///< M
  Mean residual;  ///< r^2 per axis
  Mean change;    ///< (r(t) - r(t-1))^2 per axis
  Mean stated;

  void add(Views views, Views before);
  [[nodiscard]] std::optional<double> variance() const;
};

void ViewErrors::OfJoint::add(Views views, Views before) {
  const Eigen::Vector3d r = weighted_mean(views);
  residual.add(r.squaredNorm() / 3.0);
  mean.add(variance_of_mean(views));
  if (views.front().stated > 0.0) stated.add(views.front().stated);
  if (same_sensors(views, before)) change.add((r - weighted_mean(before)).squaredNorm() / 3.0);
}

std::optional<double> ViewErrors::OfJoint::variance() const {
  if (residual.count < kFewestSteps || change.count < kFewestSteps) return std::nullopt;
  return std::max(0.0, mean.value() - std::min(residual.value(), 0.5 * change.value()));
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
