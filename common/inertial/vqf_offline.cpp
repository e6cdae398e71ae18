#include "common/inertial/vqf_offline.h"

#include <algorithm>

#include "common/geometry/rotation.h"
#include "common/inertial/vqf_parts.h"

namespace chorus::inertial {
namespace {

struct Pass {
  std::vector<Eigen::Vector3d> bias;
  std::vector<Eigen::Matrix3d> covariance;
  std::vector<char> disturbed;
};

Pass run_live(std::span<const ImuSample> samples, double period, const VqfOptions& options,
              bool backward) {
  Vqf filter(period, options);
  Pass pass;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ImuSample sample = samples[backward ? samples.size() - 1 - i : i];
    if (backward) sample.rate = -sample.rate;
    filter.update(sample);
    pass.bias.push_back(backward ? Eigen::Vector3d(-filter.state().bias) : filter.state().bias);
    pass.covariance.push_back(filter.state().bias_covariance);
    pass.disturbed.push_back(filter.state().field_disturbed ? 1 : 0);
  }
  if (!backward) return pass;
  std::ranges::reverse(pass.bias);
  std::ranges::reverse(pass.covariance);
  std::ranges::reverse(pass.disturbed);
  return pass;
}

/// The means of both passes, weighted by information; disturbed where both say so.
Pass combined(Pass forward, const Pass& backward) {
  for (std::size_t i = 0; i < forward.bias.size(); ++i) {
    const Eigen::Matrix3d a = forward.covariance[i].inverse();
    const Eigen::Matrix3d b = backward.covariance[i].inverse();
    const Eigen::Vector3d sum = a * forward.bias[i] + b * backward.bias[i];
    const Eigen::Vector3d mean = (a + b).inverse() * sum;
    if (mean.allFinite()) forward.bias[i] = mean;
    forward.disturbed[i] = forward.disturbed[i] != 0 && backward.disturbed[i] != 0 ? 1 : 0;
  }
  return forward;
}

std::vector<Eigen::Quaterniond> strapdown(std::span<const ImuSample> samples, double period,
                                          const Pass& pass) {
  std::vector<Eigen::Quaterniond> out;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].rate.allFinite())
      q = (q * exp_map((samples[i].rate - pass.bias[i]) * period)).normalized();
    out.push_back(q);
  }
  return out;
}

void filter_both_ways(std::vector<Eigen::Vector3d>& signal, const LowPassGains& gains) {
  for (int round = 0; round < 2; ++round) {
    LowPass<3> filter(gains);
    for (Eigen::Vector3d& each : signal) each = filter(each);
    std::ranges::reverse(signal);
  }
}

/// Turns what the gyroscope integrated upright.
void level(std::vector<Eigen::Quaterniond>& turned, std::span<const ImuSample> samples,
           const LowPassGains& gains) {
  std::vector<Eigen::Vector3d> up(samples.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < samples.size(); ++i) up[i] = turned[i] * samples[i].acceleration;
  filter_both_ways(up, gains);
  Eigen::Quaterniond tilt = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d seen = tilt * up[i];
    if (seen.allFinite() && seen.norm() > 0)
      tilt = (tilt_correction(seen.normalized()) * tilt).normalized();
    turned[i] = tilt * turned[i];
  }
}

std::vector<double> headings(std::span<const ImuSample> samples,
                             const std::vector<Eigen::Quaterniond>& level, const Pass& pass,
                             VqfDelta filter, bool backward) {
  std::vector<double> out(samples.size(), 0.0);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const std::size_t i = backward ? samples.size() - 1 - k : k;
    const auto& field = samples[i].field;
    if (field && field->allFinite() && field->norm() > 0)
      filter.update(asked_by(level[i] * *field), pass.disturbed[i] != 0);
    out[i] = filter.delta();
  }
  return out;
}

}  // namespace

std::vector<Eigen::Quaterniond> vqf_offline(std::span<const ImuSample> samples, double period,
                                            const VqfOptions& options) {
  const Pass pass =
      combined(run_live(samples, period, options, false), run_live(samples, period, options, true));
  std::vector<Eigen::Quaterniond> out = strapdown(samples, period, pass);
  level(out, samples, low_pass_gains(options.tau_acceleration, period));
  const VqfDelta filter(period, options);
  const std::vector<double> ahead = headings(samples, out, pass, filter, false);
  const std::vector<double> back = headings(samples, out, pass, filter, true);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double delta = ahead[i] + 0.5 * wrap_angle(back[i] - ahead[i]);
    out[i] = (Eigen::AngleAxisd(delta, Eigen::Vector3d::UnitZ()) * out[i]).normalized();
  }
  return out;
}

}  // namespace chorus::inertial
