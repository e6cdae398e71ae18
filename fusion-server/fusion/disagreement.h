// How far the views of one person differ, and what that says about the fused joints' errors.
//
// Views that differ by more than their variances say also have larger errors, and more of the
// errors that they share, which their differences do not show.  So the stated covariance of a joint
// is scaled by what the views have shown, starting from a prior:                docs/papers/body.md
//   g   <- mean over joints and 5 s of  sum_v w_v |z_v - x|^2 / (3 s_v (n - 1))              (19)
//   g_j <- g (sum of what joint j showed) / (sum of what g had it show), over 20 s           (24)
// Sensors differ in which joints they find hard, so each joint has a figure of its own, together
// with its mirror image; it is that of all joints until it has been seen for a while.
// It changes no position.  Errors that all sensors make alike are not found by this.
#pragma once

#include <array>
#include <cstddef>

#include "common/body/skeleton.h"

namespace chorus::fusion {

/// What the views of an instant differ by.
struct ShownDifference {
  double sum = 0.0;   ///< Squared distances, per axis, in the views' stated variances.
  double free = 0.0;  ///< How many of them are free: the number of views less one.
};
/// Of each joint; `free` is 0 where an instant showed nothing.
using ShownDifferences = std::array<ShownDifference, kJointCount>;

class Disagreement {
 public:
  /// `prior`: where the estimate starts; it counts as much as a second of evidence.
  explicit Disagreement(double prior) : value_(prior) {}

  /// Takes what an instant showed, `passed` [s] after the previous one.
  void learn(const ShownDifferences& found, double passed);
  /// Mean squared difference between views and body, in the views' stated variances, per degree of
  /// freedom.  1: views differ as far as their stated variances say.
  [[nodiscard]] double value() const { return value_; }
  /// The same for a joint and its mirror image.
  [[nodiscard]] double value(std::size_t joint) const;

 private:
  double value_;
  double weight_ = 1.0;  ///< [s]
  /// Of each joint: what it showed, and what value() had it show [s].
  std::array<double, kJointCount> showed_{};
  std::array<double, kJointCount> expected_{};
};

/// By what factor the variance of a mean over `views` is larger than their differences show.  Two
/// sensors have some errors alike and no third one shows it; one alone shows nothing.
[[nodiscard]] double unseen_error(std::size_t views);

}  // namespace chorus::fusion
