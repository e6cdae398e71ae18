#include "common/synthetic/kinect/shared_error.h"

#include <algorithm>
#include <cmath>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"

namespace chorus::synthetic::kinect {
namespace {

constexpr std::uint64_t kPurpose = 921;
constexpr double kOffset = 1000.0;  // keeps the cell numbers positive anywhere in a building

}  // namespace

void SharedError::fill(const Eigen::Vector2d& cell, const SharedKeys& keys) {
  for (std::size_t corner = 0; corner < corners_.size(); ++corner) {
    const auto x = static_cast<std::uint64_t>(cell.x() + static_cast<double>(corner % 2));
    const auto z = static_cast<std::uint64_t>(cell.y() + static_cast<double>(corner / 2));
    for (std::size_t row = 0; row < kRows; ++row) {
      Draw draw{kPurpose, keys.seed, keys.person, row, x, z};
      for (Eigen::Vector3d& order : corners_[corner][row]) order = draw.gauss3();
    }
  }
  cell_ = cell;
  filled_ = true;
}

void SharedError::look(const View& view, const ColouredError& coloured, const SharedKeys& keys) {
  const Eigen::Vector2d at =
      view.place / std::max(coloured.shared_cell, 1e-3) + Eigen::Vector2d::Constant(kOffset);
  const Eigen::Vector2d cell = at.array().floor();
  if (!filled_ || cell != cell_) fill(cell, keys);
  const Eigen::Vector2d s = at - cell;
  weights_ = {(1 - s.x()) * (1 - s.y()), s.x() * (1 - s.y()), (1 - s.x()) * s.y(), s.x() * s.y()};
  // Averaging the corners reduces the variance; this restores it to one.
  double squares = 0.0;
  for (const double weight : weights_) squares += weight * weight;
  for (double& weight : weights_) weight /= std::sqrt(squares);
  const double twice = std::sqrt(coloured.view_twice);
  orders_ = {std::sqrt(std::max(0.0, 1.0 - coloured.view_twice)), twice * std::cos(2 * view.facing),
             twice * std::sin(2 * view.facing)};
  sensor_from_body_ = about_y(view.heading).toRotationMatrix();
}

Eigen::Vector3d SharedError::of(JointId id, const ColouredError& coloured) const {
  const auto row_value = [&](std::size_t row) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t corner = 0; corner < corners_.size(); ++corner) {
      for (std::size_t order = 0; order < kOrders; ++order) {
        sum += weights_[corner] * orders_[order] * corners_[corner][row][order];
      }
    }
    return sum;
  };
  const Eigen::Vector3d own = row_value(index_of(id));
  if (mirror(id) != id) return sensor_from_body_ * own;
  const double common = coloured.core_correlation;
  return sensor_from_body_ *
         (std::sqrt(common) * row_value(kJointCount) + std::sqrt(1.0 - common) * own);
}

}  // namespace chorus::synthetic::kinect
