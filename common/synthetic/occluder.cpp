#include "common/synthetic/occluder.h"

#include <cmath>
#include <numbers>

namespace chorus::synthetic {

Eigen::Isometry3d place_of(const Occluder& occluder, Duration since_epoch) {
  Eigen::Isometry3d place = occluder.world_from_box;
  if (occluder.period > Duration{0}) {
    const double phase =
        2.0 * std::numbers::pi * seconds(since_epoch % occluder.period) / seconds(occluder.period);
    place.translation() += 0.5 * (1.0 - std::cos(phase)) * occluder.travel;
  }
  return place;
}

}  // namespace chorus::synthetic
