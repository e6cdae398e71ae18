#include "common/body/interpolate.h"

#include "common/geometry/rotation.h"

namespace chorus {

Joint interpolate(const Joint& a, const Joint& b, double s) {
  if (!a.given() || !b.given() || a.measurement != b.measurement) return {};
  Joint joint;
  joint.measurement = a.measurement;
  joint.position = (1.0 - s) * a.position + s * b.position;
  if (joint.measurement == Measurement::Ray) joint.position.normalize();
  joint.covariance = between(a.covariance, b.covariance, s);
  if (is_unit(a.orientation) && is_unit(b.orientation)) {
    joint.orientation = lerp(a.orientation, b.orientation, s);
  }
  joint.state = std::min(a.state, b.state);
  return joint;
}

}  // namespace chorus
