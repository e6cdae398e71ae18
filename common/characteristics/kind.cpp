#include "common/characteristics/kind.h"

#include <algorithm>
#include <cmath>

#include "common/base/median.h"

namespace chorus::characteristics {
namespace {

constexpr double kSigmasToTell = 2.0;

std::optional<double> median_of(const std::vector<Characteristics>& sensors,
                                std::vector<double> Exchange::*which) {
  std::vector<double> all;
  for (const Characteristics& sensor : sensors) {
    const std::vector<double>& own = sensor.exchange.*which;
    all.insert(all.end(), own.begin(), own.end());
  }
  if (all.empty()) return std::nullopt;
  return median(std::move(all));
}

/// What all sensors show that show anything; Mixed if they differ.
FrontRear front_rear_of(const std::vector<Characteristics>& sensors) {
  FrontRear common = FrontRear::Unknown;
  for (const Characteristics& sensor : sensors) {
    const FrontRear own = sensor.exchange.front_rear;
    if (own == FrontRear::Unknown || own == FrontRear::Unclear || own == common) continue;
    common = common == FrontRear::Unknown ? own : FrontRear::Mixed;
  }
  return common;
}

Noise joined(const std::vector<Characteristics>& sensors, Noise (*of)(const Jitter&)) {
  Noise whole;
  double count = 0.0;
  double factor = 0.0;
  for (const Characteristics& sensor : sensors) {
    const Noise own = of(sensor.jitter);
    whole.along += own.along * own.along;
    whole.across += own.across * own.across;
    factor += own.inferred_factor * static_cast<double>(own.inferred_frames);
    whole.inferred_frames += own.inferred_frames;
    ++count;
  }
  if (count == 0.0) return whole;
  whole.along = std::sqrt(whole.along / count);
  whole.across = std::sqrt(whole.across / count);
  if (whole.inferred_frames > 0)
    whole.inferred_factor = factor / static_cast<double>(whole.inferred_frames);
  return whole;
}

Delivery mean_delivery(const std::vector<Characteristics>& sensors) {
  Delivery mean;
  const double each = 1.0 / static_cast<double>(std::max<std::size_t>(1, sensors.size()));
  for (const Characteristics& sensor : sensors) {
    const Delivery& own = sensor.coverage.delivery;
    mean.step += each * own.step;
    mean.step_sigma += each * own.step_sigma;
    mean.lost_share += each * own.lost_share;
    mean.longest_gap = std::max(mean.longest_gap, own.longest_gap);
    mean.empty_share += each * own.empty_share;
  }
  return mean;
}

std::optional<Noise> told_noise(const Measured& measured, const Noise& jitter, double usual) {
  Noise noise = jitter;
  if (measured.agreement) {
    noise.along = std::max(measured.agreement->along, jitter.along);
    noise.across = std::max(measured.agreement->across, jitter.across);
    return noise;
  }
  if (std::max(jitter.along, jitter.across) <= usual) return std::nullopt;
  noise.along = std::max(jitter.along, usual);
  noise.across = std::max(jitter.across, usual);
  return noise;
}

std::optional<MeasuredDepthBias> told_bias(const Measured& measured) {
  std::optional<MeasuredDepthBias> bias = measured.walked_bias;
  for (const Characteristics& sensor : measured.sensors) {
    if (sensor.depth_bias) bias = sensor.depth_bias->mean;
  }
  if (bias && bias->bias < kSigmasToTell * bias->sigma) return std::nullopt;
  return bias;
}

}  // namespace

Kind kind_of(const Measured& measured, double usual) {
  Kind kind;
  kind.front_rear = front_rear_of(measured.sensors);
  kind.exchanged_at = median_of(measured.sensors, &Exchange::out);
  kind.back_at = median_of(measured.sensors, &Exchange::back);
  kind.jitter = joined(measured.sensors, &noise_of);
  kind.limb_jitter = joined(measured.sensors, &limb_noise_of);
  kind.delivery = mean_delivery(measured.sensors);
  kind.noise = told_noise(measured, kind.jitter, usual);
  kind.depth_bias = told_bias(measured);
  return kind;
}

}  // namespace chorus::characteristics
