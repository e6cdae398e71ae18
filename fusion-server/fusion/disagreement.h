// How far the views of one person differ, and what that says about the fused joints' errors.
//
// Views that differ by more than their variances say also have larger errors, and more of the
// errors that they share, which their differences do not show.  So the stated covariance of a joint
// is scaled by a slow average of what the views have shown, starting from a prior:
//                                                                        docs/papers/body.md (19)
//   g <- mean over joints and 5 s of  sum_v w_v |z_v - x|^2 / (3 s_v (n - 1))
// It changes no position.  Errors that all sensors make alike are not found by this.
#pragma once

#include <cstddef>
#include <optional>

namespace chorus::fusion {

class Disagreement {
 public:
  /// `prior`: where the estimate starts; it counts as much as a second of evidence.
  explicit Disagreement(double prior) : value_(prior) {}

  /// Takes what an instant showed, `passed` [s] after the previous one; none: it showed nothing.
  void learn(const std::optional<double>& found, double passed);
  /// Mean squared difference between views and body, in the views' stated variances, per degree of
  /// freedom.  1: views differ as far as their stated variances say.
  [[nodiscard]] double value() const { return value_; }

 private:
  double value_;
  double weight_ = 1.0;  ///< [s]
};

/// By what factor the variance of a mean over `views` is larger than their differences show.  Two
/// sensors have some errors alike and no third one shows it; one alone shows nothing.
[[nodiscard]] double unseen_error(std::size_t views);

}  // namespace chorus::fusion
