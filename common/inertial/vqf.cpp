#include "common/inertial/vqf.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/rotation.h"
#include "common/inertial/low_pass.h"
#include "common/inertial/vqf_parts.h"

namespace chorus::inertial {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;

// Values of the paper's Table 2.
constexpr double kBiasSigmaInit = deg(0.5);
constexpr double kBiasForgettingTime = 100.0;  // [s] in which 0.1 deg/s are forgotten
constexpr double kBiasForgotten = deg(0.1);
constexpr double kBiasClip = deg(2.0);
constexpr double kBiasSigmaMotion = deg(0.1);
constexpr double kBiasVerticalForgetting = 1e-4;
constexpr double kBiasSigmaRest = deg(0.03);
constexpr double kRestMinTime = 1.5;
constexpr double kRestTau = 0.5;
constexpr double kRestRate = deg(2.0);
constexpr double kRestAcceleration = 0.5;

Eigen::Vector3d clipped(const Eigen::Vector3d& v) {
  return v.cwiseMax(-kBiasClip).cwiseMin(kBiasClip);
}

}  // namespace

Eigen::Quaterniond tilt_correction(const Eigen::Vector3d& up) {
  const double w = std::sqrt(std::max(0.0, (up.z() + 1.0) / 2.0));
  if (w < 1e-6) return {0, 1, 0, 0};  // upside down: any horizontal axis does
  return Eigen::Quaterniond(w, 0.5 * up.y() / w, -0.5 * up.x() / w, 0.0).normalized();
}

struct Vqf::Impl {
  Impl(double sample_period, const VqfOptions& chosen)
      : options(chosen),
        period(sample_period),
        rest_rate(low_pass_gains(kRestTau, sample_period)),
        rest_acceleration(low_pass_gains(kRestTau, sample_period)),
        acceleration(low_pass_gains(chosen.tau_acceleration, sample_period)),
        turned(low_pass_gains(chosen.tau_acceleration, sample_period)),
        turned_bias(low_pass_gains(chosen.tau_acceleration, sample_period)),
        heading(sample_period, chosen) {
    state.bias_covariance = Eigen::Matrix3d::Identity() * kBiasSigmaInit * kBiasSigmaInit;
  }

  void gyroscope(const Eigen::Vector3d& rate) {
    const Eigen::Vector3d mean = rest_rate(rate);
    if ((rate - mean).squaredNorm() >= kRestRate * kRestRate ||
        mean.cwiseAbs().maxCoeff() > kBiasClip)
      rest_time = 0.0;
    integrated = (integrated * exp_map((rate - state.bias) * period)).normalized();
  }

  void accelerometer(const Eigen::Vector3d& sample) {
    const Eigen::Vector3d mean = rest_acceleration(sample);
    if ((sample - mean).squaredNorm() >= kRestAcceleration * kRestAcceleration)
      rest_time = 0.0;
    else
      rest_time += period;
    state.at_rest = options.bias_at_rest && rest_time >= kRestMinTime;
    const Eigen::Vector3d level = tilt * acceleration(integrated * sample);
    if (level.norm() <= 0.0) return;
    const Eigen::Vector3d up = level.normalized();
    tilt = (tilt_correction(up) * tilt).normalized();
    estimate_bias(up);
  }

  /// Eqs. (19)-(27): at rest the mean rate is the bias; in motion the tilt corrections show its
  /// horizontal part, and the vertical one is drawn to zero, slowly.
  void estimate_bias(const Eigen::Vector3d& up) {
    const Eigen::Matrix3d now = (tilt * integrated).toRotationMatrix();
    const Vector9d mean = turned(Eigen::Map<const Vector9d>(now.data()));
    const Eigen::Vector2d mean_bias = turned_bias((now * state.bias).head<2>());
    Eigen::Matrix3d& p = state.bias_covariance;
    const double v = kBiasForgotten * kBiasForgotten * period / kBiasForgettingTime;
    const auto weight = [&](double sigma) {
      return sigma * sigma * sigma * sigma / v + sigma * sigma;
    };
    for (int i = 0; i < 3; ++i)
      if (p(i, i) < kBiasSigmaInit * kBiasSigmaInit) p(i, i) += v;
    if (state.at_rest) {
      correct_bias(Eigen::Matrix3d::Identity(), rest_rate.last() - state.bias,
                   Eigen::Vector3d::Constant(weight(kBiasSigmaRest)));
    } else if (options.bias_in_motion) {
      const Eigen::Matrix3d r = Eigen::Map<const Eigen::Matrix3d>(mean.data());
      Eigen::Vector3d e = -(r * state.bias);
      e.x() += mean_bias.x() - up.y() / period;
      e.y() += mean_bias.y() + up.x() / period;
      const double w = weight(kBiasSigmaMotion);
      correct_bias(r, e, {w, w, w / kBiasVerticalForgetting});
    }
  }

  void correct_bias(const Eigen::Matrix3d& r, const Eigen::Vector3d& e, const Eigen::Vector3d& w) {
    Eigen::Matrix3d& p = state.bias_covariance;
    const Eigen::Matrix3d seen = r * p * r.transpose() + Eigen::Matrix3d(w.asDiagonal());
    const Eigen::Matrix3d gain = p * r.transpose() * seen.inverse();
    state.bias = clipped(state.bias + gain * clipped(e));
    p -= gain * r * p;
  }

  VqfOptions options;
  double period;
  LowPass<3> rest_rate, rest_acceleration, acceleration;
  LowPass<9> turned;
  LowPass<2> turned_bias;
  VqfHeading heading;
  Eigen::Quaterniond integrated = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond tilt = Eigen::Quaterniond::Identity();
  double rest_time = 0.0;
  VqfState state;
};

Vqf::Vqf(double period, const VqfOptions& options)
    : impl_(std::make_unique<Impl>(period, options)) {}
Vqf::Vqf(Vqf&&) noexcept = default;
Vqf& Vqf::operator=(Vqf&&) noexcept = default;
Vqf::~Vqf() = default;

void Vqf::update(const ImuSample& sample) {
  Impl& now = *impl_;
  if (sample.rate.allFinite()) now.gyroscope(sample.rate);
  if (sample.acceleration.allFinite() && sample.acceleration.norm() > 0)
    now.accelerometer(sample.acceleration);
  now.state.six_axis = now.tilt * now.integrated;
  if (sample.field && sample.field->allFinite() && sample.field->norm() > 0)
    now.heading.update(now.state.six_axis * *sample.field, now.rest_rate.last().norm());
  now.state.field_disturbed = now.heading.disturbed();
  now.state.nine_axis =
      Eigen::AngleAxisd(now.heading.delta(), Eigen::Vector3d::UnitZ()) * now.state.six_axis;
}

const VqfState& Vqf::state() const { return impl_->state; }

}  // namespace chorus::inertial
