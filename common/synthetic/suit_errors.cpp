#include "common/synthetic/suit_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry/rotation.h"
#include "common/synthetic/coloured_noise.h"
#include "common/synthetic/smoothstep.h"

namespace chorus::synthetic {
namespace {

using inertial::Limb;
using Kind = SuitFault::Kind;

enum SuitDraw : std::uint64_t {
  kSkinDraw = 321,
  kDriftDraw,
  kBiasDraw,
  kChargeDraw,
  kPronationDraw
};

constexpr double kBiasTau = 100.0;    // of a gyroscope that warms up and cools [s]
constexpr double kFieldEdge = 1.0;    // how long a person takes to walk up to iron [s]
constexpr double kSlipTakes = 0.3;    // [s]
constexpr double kFullCharge = 3e4;   // how long a battery lasts [s]: eight hours
constexpr double kChargeSpread = .3;  // batteries differ by so much, as a share

Draw draw_of(const SimulatedSuit& suit, SuitDraw purpose, Limb limb, std::uint64_t axis = 0) {
  return Draw{suit.seed, purpose, inertial::index_of(limb), axis};
}

/// How long after the fault's beginning [s]; nothing before it and after its end.
std::optional<double> into(const SuitFault& fault, double since) {
  const double begin = seconds(fault.begin);
  if (since < begin || (fault.end != Duration::max() && since >= seconds(fault.end)))
    return std::nullopt;
  return since - begin;
}

template <class Use>
void each_fault(const SimulatedSuit& suit, Kind kind, Limb limb, const Use& use) {
  for (const SuitFault& fault : suit.faults)
    if (fault.kind == kind && fault.limb == limb) use(fault);
}

double share_of_ramp(double time, double length) {
  return smoothstep(std::clamp(time / length, 0.0, 1.0));
}

}  // namespace

SkinRow skin_of(Limb limb) {
  // clang-format off
  constexpr SkinRow kUpperArm{deg(2.0), deg(6.0), deg(2.9), 1.2};
  constexpr SkinRow kForearm{deg(1.1), deg(1.9), deg(1.5), 0.5};
  constexpr SkinRow kThigh{deg(2.5), deg(2.2), deg(5.8), 0.4};
  constexpr SkinRow kShank{deg(1.3), deg(0.7), deg(3.3), 0.2};
  constexpr SkinRow kFoot{deg(1.0), deg(1.9), deg(2.5), 0.3};
  constexpr std::array<SkinRow, inertial::kLimbCount> kRows{{
    {deg(2.4), deg(1.6), deg(1.8), 0.35}, {deg(1.8), deg(2.0), deg(4.4), 0.9}, {deg(1.2), deg(1.5), deg(0.8), 0.9},
    kUpperArm, kForearm, kForearm, kUpperArm, kForearm, kForearm,
    kThigh, kShank, kFoot, kThigh, kShank, kFoot}};
  // clang-format on
  return kRows[inertial::index_of(limb)];
}

Eigen::Quaterniond skin_error(const SimulatedSuit& suit, Limb limb, double since) {
  if (!(suit.errors.skin > 0.0)) return Eigen::Quaterniond::Identity();
  const SkinRow row = skin_of(limb);
  const auto about = [&](std::uint64_t axis, double sigma) {
    return suit.errors.skin * sigma *
           ColouredNoise(draw_of(suit, kSkinDraw, limb, axis), row.tau).at(since);
  };
  return exp_map({about(0, row.side), about(1, row.twist), about(2, row.ahead)});
}

double pronation(const SimulatedSuit& suit, Limb limb, double since) {
  constexpr double kSigma = deg(5.9);  // robust: 68 % stay below
  constexpr double kTau = 1.3;         // [s]
  constexpr double kPeak = 3.0;        // power of the distribution, 1: normal
  if (limb != Limb::ForearmLeft && limb != Limb::ForearmRight) return 0.0;
  if (!(suit.errors.skin > 0.0)) return 0.0;
  const double noise = ColouredNoise(draw_of(suit, kPronationDraw, limb), kTau).at(since);
  return suit.errors.skin * kSigma * std::copysign(std::pow(std::abs(noise), kPeak), noise);
}

double disturbance(const SimulatedSuit& suit, Limb limb, double since) {
  double sum = 0.0;
  each_fault(suit, Kind::Disturbance, limb, [&](const SuitFault& fault) {
    const auto time = into(fault, since);
    if (!time) return;
    const double left = fault.end == Duration::max() ? kFieldEdge : seconds(fault.end) - since;
    sum += fault.size * share_of_ramp(*time, kFieldEdge) * share_of_ramp(left, kFieldEdge);
  });
  return sum;
}

double heading_error(const SimulatedSuit& suit, Limb limb, double since) {
  const double disturbed = disturbance(suit, limb, since);
  if (suit.errors.magnetometer) return disturbed;
  const double rate =
      suit.errors.heading_drift * draw_of(suit, kDriftDraw, limb).uniform(-1.0, 1.0);
  double walked = 0.0;
  if (suit.errors.bias_walk > 0.0)
    walked = suit.errors.bias_walk *
             ColouredNoise(draw_of(suit, kBiasDraw, limb), kBiasTau).integral(since);
  return rate * since + walked;
}

Eigen::Quaterniond slip_error(const SimulatedSuit& suit, Limb limb, double since) {
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
  each_fault(suit, Kind::Slip, limb, [&](const SuitFault& fault) {
    const double time = since - seconds(fault.begin);
    if (time < 0.0 || !(fault.axis.norm() > 1e-9)) return;
    const double angle = fault.size * share_of_ramp(time, kSlipTakes);
    turned = turned * exp_map(angle * fault.axis.normalized());
  });
  return turned;
}

std::optional<double> charge_left(const SimulatedSuit& suit, Limb limb, double since) {
  const double lasts =
      kFullCharge * draw_of(suit, kChargeDraw, limb).uniform(1.0 - kChargeSpread, 1.0);
  double charge = 1.0 - since / lasts;
  bool silent = false;
  each_fault(suit, Kind::Silence, limb,
             [&](const SuitFault& fault) { silent = silent || into(fault, since).has_value(); });
  each_fault(suit, Kind::BatteryDeath, limb, [&](const SuitFault& fault) {
    charge = std::min(charge, 1.0 - since / std::max(1e-9, seconds(fault.begin)));
  });
  if (silent || charge <= 0.0) return std::nullopt;
  return std::min(1.0, charge);
}

Limb felt_limb(const SimulatedSuit& suit, Limb limb, double since) {
  for (const SuitFault& fault : suit.faults) {
    if (fault.kind != Kind::Swap || !into(fault, since)) continue;
    if (fault.limb == limb) return fault.other;
    if (fault.other == limb) return fault.limb;
  }
  return limb;
}

double stated_share(const SimulatedSuit& suit, Limb limb, double since) {
  double share = 1.0;
  each_fault(suit, Kind::Lie, limb, [&](const SuitFault& fault) {
    if (into(fault, since)) share *= fault.size;
  });
  return share;
}

}  // namespace chorus::synthetic
