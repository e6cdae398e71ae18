#include "fusion-server/facing/front_rear.h"

#include "common/body/facing.h"

namespace chorus::facing {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Aspect aspect_of(const BodyFrame& body) {
  return {neck_distance(body.skeleton).value_or(kUnknown),
          facing_angle(body.skeleton).value_or(kUnknown),
          bearing_angle(body.skeleton).value_or(kUnknown),
          axis_bearing_angle(body.skeleton).value_or(kUnknown)};
}

}  // namespace chorus::facing
