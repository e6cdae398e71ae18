#include "common/synthetic/kinect/fitted_body.h"

#include <algorithm>
#include <cmath>

#include "common/synthetic/draw.h"

namespace chorus::synthetic::kinect {
namespace {

enum Purpose : std::uint64_t { kScale = 951, kScaleWhite, kProportion };

constexpr double kLeastScale = 0.5;  // Smallest scale that an SDK would fit.

std::uint64_t stamp_of(double time) {
  return static_cast<std::uint64_t>(std::max(0.0, time * 1e6));
}

/// Mean of the seen core joints; zero without any.
Eigen::Vector3d trunk_of(const Skeleton<SensorSpace>& body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const JointId id : kCoreJoints) {
    if (!body[id].seen()) continue;
    sum += body[id].position;
    count += 1.0;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : sum;
}

}  // namespace

Proportions proportions_of(const BodyFit& fit, const ErrorKeys& keys) {
  Proportions all;
  for (std::size_t i = 0; i < kBones.size(); ++i) {
    const auto side = std::min(index_of(kBones[i].child), index_of(mirror(kBones[i].child)));
    all[i] = 1.0 + fit.proportion * Draw{kProportion, keys.seed, keys.person, side}.gauss();
  }
  return all;
}

void advance(FitState& state, const Stand& stand, const Moment& moment, const Profile& profile,
             const ErrorKeys& keys) {
  const double speed = stand.speed[index_of(JointId::SpineShoulder)];
  state.scale.advance(moment.dt * activity(speed, profile.coloured), profile.fit.scale_tau,
                      Draw{kScale, keys.seed, keys.sensor, keys.person, stamp_of(moment.time)});
}

double scale_of(const FitState& state, double time, const BodyFit& fit, const ErrorKeys& keys) {
  Draw white{kScaleWhite, keys.seed, keys.sensor, keys.person, stamp_of(time)};
  const double off = fit.scale * state.scale.value().x() + fit.scale_white * white.gauss();
  return std::max(kLeastScale, 1.0 + off);
}

Skeleton<SensorSpace> fitted(const Skeleton<SensorSpace>& erring,
                             const Skeleton<SensorSpace>& exact, double scale,
                             const Proportions& proportions) {
  Skeleton<SensorSpace> body = erring;
  for (std::size_t i = 0; i < kBones.size(); ++i) {  // parents come before children
    const auto [parent, child] = kBones[i];
    if (!erring[parent].seen() || !erring[child].seen()) continue;
    const double length = (exact[child].position - exact[parent].position).norm();
    const Eigen::Vector3d way = erring[child].position - erring[parent].position;
    body[child].position =
        body[parent].position + scale * proportions[i] * length * way.stableNormalized();
  }
  const Eigen::Vector3d back = trunk_of(erring) - trunk_of(body);
  for (Joint& joint : body.joints) {
    if (joint.seen()) joint.position += back;
  }
  return body;
}

}  // namespace chorus::synthetic::kinect
