// Butterworth low-pass of second order for a vector of signals, started as VQF does.
//
// D. Laidig, T. Seel, VQF, Information Fusion 2023, Eqs. (5)-(7): cut-off sqrt(2) / (2 pi tau); in
// the first tau seconds the output is the mean of all samples so far, so that no single sample
// decides where the filter starts.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace chorus::inertial {

struct LowPassGains {
  double b0 = 1.0, b1 = 0.0, b2 = 0.0, a1 = 0.0, a2 = 0.0;
  std::size_t starting_samples = 1;  ///< Samples within tau.
};

/// For a time constant `tau` and samples every `period` [s]; tau <= period / 2 passes all through.
[[nodiscard]] LowPassGains low_pass_gains(double tau, double period);

/// N signals; total: a sample that is not finite leaves the filter as it is.
template <int N>
class LowPass {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit LowPass(const LowPassGains& gains) : gains_(gains) {}

  Vector operator()(const Vector& sample) {
    if (!sample.allFinite()) return last_;
    if (seen_ < gains_.starting_samples) {
      sum_ += sample;
      ++seen_;
      last_ = sum_ / static_cast<double>(seen_);
      settle(last_);
      return last_;
    }
    last_ = gains_.b0 * sample + first_;
    first_ = gains_.b1 * sample - gains_.a1 * last_ + second_;
    second_ = gains_.b2 * sample - gains_.a2 * last_;
    return last_;
  }
  [[nodiscard]] const Vector& last() const { return last_; }

 private:
  /// The state of a filter that has seen nothing but `level`.
  void settle(const Vector& level) {
    first_ = level * (1.0 - gains_.b0);
    second_ = level * (gains_.b2 - gains_.a2);
  }

  LowPassGains gains_;
  std::size_t seen_ = 0;
  Vector sum_ = Vector::Zero(), last_ = Vector::Zero();
  Vector first_ = Vector::Zero(), second_ = Vector::Zero();
};

/// The share of a new sample in a first-order filter: 1 - exp(-period / tau); 0 for tau < 0, 1 for
/// tau = 0.
[[nodiscard]] double first_order_gain(double tau, double period);

}  // namespace chorus::inertial
