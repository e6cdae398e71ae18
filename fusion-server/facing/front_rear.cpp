#include "fusion-server/facing/front_rear.h"

#include <cmath>

#include "common/base/units.h"
#include "common/body/facing.h"

namespace chorus::facing {
namespace {

constexpr double kSideView = deg(90);
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Sight view_of(const BodyFrame& body) {
  return {neck_distance(body.skeleton).value_or(kUnknown),
          facing_angle(body.skeleton).value_or(kUnknown),
          bearing_angle(body.skeleton).value_or(kUnknown)};
}

bool from_behind(const Sight& sight) noexcept { return std::abs(sight.facing) > kSideView; }

}  // namespace chorus::facing
