// How large the errors of the fused joints are, from how their views disagree; beside what was
// stated.
//
// Views i of one joint at one instant err independently of one another; their shares w_i (the sum
// is 1) weigh them by how well each is known in that instant. So the variance per axis of their
// mean m is  M = E[sum w_i w_k (x_i - x_k)^2 / (n - 1)]  over pairs i < k of n views.  Differences
// of views are free of what is fused and of motion.
//
// The fused joint f follows m over several instants.  The error e of a best linear estimate is
// uncorrelated with its residual r = m - f (orthogonality principle), so that it is smaller than
// m's by the variance of r.  That holds for what is new in every instant; what lasts in r, such as
// the lag behind a motion, makes nothing better.  Half of E[(r(t) - r(t-1))^2] is the part of
// E[r^2] that does not last:
//   E[e^2] = M - min(E[r^2], E[(r(t) - r(t-1))^2] / 2).
//
// Errors that all views share, such as a wrong floor, show in no disagreement: what is found is too
// small then.
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
