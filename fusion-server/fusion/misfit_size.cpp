#include "fusion-server/fusion/misfit_size.h"

#include <algorithm>
#include <cmath>

namespace chorus::fusion {
namespace {

constexpr double kPrior = 1.0;        // [s] of evidence that the configured sizes count for
constexpr double kMemory = 5.0;       // [s]
constexpr double kLongestGap = 0.1;   // [s] the most that an instant counts for, after a gap
constexpr double kLeastSideOn = 0.3;  // a view nearer to frontal says nothing about turns
constexpr double kLeastVariance = 1e-16;

}  // namespace

void MisfitSize::Square::learn(double sum, double count, double passed, double start) {
  if (weight == 0.0) {
    weight = kPrior;
    value = start * start;
  }
  if (!(count > 0)) return;
  weight = std::exp(-passed / kMemory) * weight + passed;
  value += passed / weight * (sum / count - value);
}

void MisfitSize::learn(std::span<const Misfit> misfits, double passed, const BodyModel& model) {
  double scales = 0.0;
  double views = 0.0;
  double turns = 0.0;
  double turned = 0.0;
  for (const Misfit& each : misfits) {
    if (!(each.scale_variance > kLeastVariance)) continue;
    scales += each.scale * each.scale + each.scale_variance;
    views += 1.0;
    if (!(each.side_on > kLeastSideOn)) continue;
    turns += each.turn * each.turn + each.turn_variance;
    turned += each.side_on * each.side_on;
  }
  const double time = std::clamp(passed, 0.0, kLongestGap);
  scale_.learn(scales, views, time, model.scale);
  turn_.learn(turns, turned, time, model.turn);
}

BodyModel MisfitSize::found(BodyModel model) const {
  if (scale_.weight > 0 && model.scale > 0) model.scale = std::sqrt(scale_.value);
  if (turn_.weight > 0 && model.turn > 0) model.turn = std::sqrt(turn_.value);
  return model;
}

}  // namespace chorus::fusion
