// How large the errors of the fused joints are, from how their views disagree; beside what was
// stated.
//
// Views i of one joint at one instant err by x_i = a_i + b_i, independent of one another: a_i is
// new in every instant, with variance s_i per axis, b_i lasts, with variance l_i.  The tracker
// follows their mean m = sum w_i x_i with a gain g a step:  f(t) = f(t-1) + g (m(t) - f(t-1)).
// Differences of two views are free of f and of motion:
//   E[d_ik(t) d_ik(t)]   = s_i + l_i + s_k + l_k      and      E[d_ik(t) d_ik(t-1)] = l_i + l_k,
// least squares over all pairs give s and l.  With S = sum w_i^2 s_i, L = sum w_i^2 l_i and
// r = m - f the weighted mean of the residuals, the gain follows from how r changes in a step,
// which hides what is slow, motion that f lags behind included:
//   E[(r(t) - r(t-1))^2] = S (1-g)^2 (1 + (1+g)^2 + g^3 / (2-g)),
// and the error of f from  E[r^2] = (S + L) + E[f^2] - 2 (g S + L).  Errors that all views share,
// such as a wrong floor, show in no disagreement: what is found is too small then.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
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
  ViewErrors();
  ~ViewErrors();
  ViewErrors(ViewErrors&&) noexcept;
  ViewErrors& operator=(ViewErrors&&) noexcept;

  /// All views of one step; of several views of one joint by one sensor the last one counts.
  /// Steps follow one another as the output does.
  void add(const std::vector<ViewResidual>& step);
  [[nodiscard]] std::array<ViewError, kJointCount> finish() const;

 private:
  struct OfJoint;

  std::array<std::unique_ptr<OfJoint>, kJointCount> joints_;
  std::vector<ViewResidual> before_;  ///< Of the last step, in order of person, joint, sensor.
};

}  // namespace chorus::quality
