// How large the errors of the fused joints are, from how their views disagree; beside what was
// stated.
//
// The fused joint is a mean of its views with known shares w.  Views i, j of one joint at one
// instant lie r_i, r_j beside it.  If the errors of views are independent, with variance s_i per
// axis, and the mean's own is e, then  E[r_i r_i] = s_i (1 - 2 w_i) + e  and
// E[r_i r_j] = e - w_i s_i - w_j s_j  (per axis; both follow from r_i = x_i - sum w_k x_k).  Least
// squares over all pairs give e.  Errors that all views share, such as a wrong floor, show in no
// disagreement: e is too small then.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/body/skeleton.h"

namespace chorus::quality {

/// A view of a joint of one person at one step of the output.
struct ViewResidual {
  std::uint64_t person = 0;
  std::size_t joint = 0;
  std::size_t sensor = 0;                         ///< Any numbering from 0.
  Eigen::Vector3d off = Eigen::Vector3d::Zero();  ///< The view minus the fused joint [m].
  double share = 0.0;                             ///< Of the view in the fused joint.
  double stated = 0.0;  ///< Stated variance of the fused joint per axis [m^2]; 0: none.
};

/// Of one joint: root mean squares per axis [m]; NaN: unknown.
struct ViewError {
  double found = 0.0;   ///< By the disagreement of views.
  double stated = 0.0;  ///< In the same instants.
};

class ViewErrors {
 public:
  /// All views of one step; of several views of one joint by one sensor the last one counts.
  void add(const std::vector<ViewResidual>& step);
  [[nodiscard]] std::array<ViewError, kJointCount> finish() const;

 private:
  /// Normal equations of one joint: unknown are the sensors' variances and, last, the mean's.
  struct Equations {
    Eigen::MatrixXd squares;
    Eigen::VectorXd values;
    std::size_t rows = 0;
    double stated = 0.0;
    std::size_t instants = 0;
  };

  void add_joint(const ViewResidual* first, std::size_t count);

  std::array<Equations, kJointCount> joints_;
};

}  // namespace chorus::quality
