#include "common/quality/view_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <Eigen/Dense>

namespace chorus::quality {
namespace {

constexpr std::size_t kMostSensors = 64;
constexpr std::size_t kFewestRows = 300;
constexpr double kFarthest = 0.5;  // [m]; a view farther off is of something else
constexpr double kRidge = 1e-9;    // of the equations' size: a sensor without views has variance 0

auto place_of(const ViewResidual& view) { return std::tuple(view.person, view.joint, view.sensor); }

}  // namespace

void ViewErrors::add(const std::vector<ViewResidual>& step) {
  std::vector<ViewResidual> views;
  for (const ViewResidual& view : step)
    if (view.sensor < kMostSensors && view.joint < kJointCount && view.off.norm() < kFarthest)
      views.push_back(view);
  std::ranges::stable_sort(views, {}, place_of);
  std::vector<ViewResidual> last;
  for (const ViewResidual& view : views) {
    if (!last.empty() && place_of(last.back()) == place_of(view))
      last.back() = view;
    else
      last.push_back(view);
  }
  for (std::size_t from = 0; from < last.size();) {
    std::size_t to = from + 1;
    while (to < last.size() && last[to].person == last[from].person &&
           last[to].joint == last[from].joint)
      ++to;
    if (to - from >= 2) add_joint(&last[from], to - from);
    from = to;
  }
}

void ViewErrors::add_joint(const ViewResidual* first, std::size_t count) {
  Equations& all = joints_[first->joint];
  constexpr auto kUnknowns = static_cast<Eigen::Index>(kMostSensors + 1);
  constexpr Eigen::Index kMean = kUnknowns - 1;
  if (all.rows == 0) {
    all.squares = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
    all.values = Eigen::VectorXd::Zero(kUnknowns);
  }
  const auto row = [&](std::initializer_list<std::pair<Eigen::Index, double>> terms, double value) {
    for (const auto& [i, a] : terms) {
      all.values[i] += a * value;
      for (const auto& [j, b] : terms) all.squares(i, j) += a * b;
    }
    ++all.rows;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const auto one = static_cast<Eigen::Index>(first[i].sensor);
    row({{one, 1.0 - 2.0 * first[i].share}, {kMean, 1.0}}, first[i].off.squaredNorm() / 3.0);
    for (std::size_t k = i + 1; k < count; ++k)
      row({{one, -first[i].share},
           {static_cast<Eigen::Index>(first[k].sensor), -first[k].share},
           {kMean, 1.0}},
          first[i].off.dot(first[k].off) / 3.0);
  }
  if (!(first->stated > 0.0)) return;
  all.stated += first->stated;
  ++all.instants;
}

std::array<ViewError, kJointCount> ViewErrors::finish() const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::array<ViewError, kJointCount> out;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Equations& all = joints_[j];
    out[j] = {kNone, kNone};
    if (all.instants > 0) out[j].stated = std::sqrt(all.stated / static_cast<double>(all.instants));
    if (all.rows < kFewestRows) continue;
    Eigen::MatrixXd squares = all.squares;
    squares.diagonal().array() += kRidge * static_cast<double>(all.rows);
    const Eigen::VectorXd found = squares.ldlt().solve(all.values);
    const double mean = found[found.size() - 1];
    if (std::isfinite(mean)) out[j].found = std::sqrt(std::max(0.0, mean));
  }
  return out;
}

}  // namespace chorus::quality
