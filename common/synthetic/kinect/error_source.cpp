#include "common/synthetic/kinect/error_source.h"

#include <algorithm>
#include <cmath>

namespace chorus::synthetic::kinect {
namespace {

constexpr double kMostDropped = 0.9;  // So that some frames still arrive.

double share(double value, double factor) { return std::clamp(value * factor, 0.0, 1.0); }

void scale(Visibility& visibility, double factor) {
  visibility.inferred_visible = share(visibility.inferred_visible, factor);
  visibility.hidden_scale *= factor;
  if (factor <= 0) visibility.rays = 0;
}

/// Moves the angle towards half a turn for factors below 1, towards the reliable angle above 1.
double flip_angle(double angle, double reliable, double factor) {
  if (angle >= deg(180)) return angle;  // An angle that is never reached stays so.
  if (factor < 1) return angle + (1.0 - factor) * (deg(180) - angle);
  return reliable + (angle - reliable) / factor;
}

void scale(YawBehaviour& yaw, double factor) {
  yaw.shoulder_slope = std::pow(yaw.shoulder_slope, factor);
  yaw.hip_slope = std::pow(yaw.hip_slope, factor);
  yaw.flip_to_front = flip_angle(yaw.flip_to_front, yaw.reliable, factor);
  for (double* own : {&yaw.flip_own, &yaw.flip_back_own}) *own /= std::max(1.0, factor);
  yaw.flip_to_rear =
      factor > 0 ? flip_angle(yaw.flip_to_rear, yaw.reliable, factor) : deg(360);  // never
}

void scale(JointBias& bias, double factor) {
  for (double* each : {&bias.core, &bias.head_forward, &bias.hip_radial, &bias.vertical})
    *each *= factor;
}

void scale(ColouredError& coloured, double factor) {
  coloured.scale *= factor;
  coloured.inferred_least *= factor;
  coloured.inferred_pull = share(coloured.inferred_pull, factor);
}

void scale(GrossError& gross, double factor) {
  gross.teleports *= factor;
  gross.ghosts_per_minute *= factor;
  gross.id_swap = share(gross.id_swap, factor);
  gross.leg_merge = share(gross.leg_merge, factor);
}

void scale(Delivery& delivery, double factor) {
  delivery.drop_share = std::min(kMostDropped, delivery.drop_share * factor);
  delivery.slow_share = share(delivery.slow_share, factor);
  delivery.gaps_per_minute *= factor;
  delivery.jitter *= factor;
  delivery.latency_jitter *= factor;
}

void scale(ClockError& clock, double factor) {
  clock.offset *= factor;
  clock.drift *= factor;
  clock.step *= factor;
  clock.step_chance = share(clock.step_chance, factor);
}

}  // namespace

Profile with_source(Profile profile, Source source, double factor) {
  switch (source) {
    case Source::Visibility:
      scale(profile.visibility, factor);
      break;
    case Source::Yaw:
      scale(profile.yaw, factor);
      break;
    case Source::Bias:
      scale(profile.bias, factor);
      break;
    case Source::Coloured:
      scale(profile.coloured, factor);
      break;
    case Source::White:
      profile.white_scale *= factor;
      break;
    case Source::Gross:
      scale(profile.gross, factor);
      break;
    case Source::Delivery:
      scale(profile.delivery, factor);
      break;
    case Source::Clock:
      scale(profile.clock, factor);
      break;
  }
  return profile;
}

}  // namespace chorus::synthetic::kinect
