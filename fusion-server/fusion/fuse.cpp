#include "fusion-server/fusion/fuse.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "fusion-server/fusion/inverse_variance.h"
#include "fusion-server/fusion/weight.h"
#include "fusion-server/fusion/weighted_mean.h"

namespace chorus::fusion {
namespace {

constexpr std::size_t kMostSensors = 64;  // bits of FusedBody::contributors
constexpr std::array<std::pair<Method, std::string_view>, 4> kMethodNames{{
    {Method::Otto, "otto"},
    {Method::Mean, "mean"},
    {Method::BestView, "best-view"},
    {Method::InverseVariance, "inverse-variance"},
}};

std::uint64_t bit_of(const SensorId& sensor, const std::vector<SensorId>& sensors) {
  const auto at = std::find(sensors.begin(), sensors.end(), sensor);
  const auto index = static_cast<std::size_t>(at - sensors.begin());
  return at == sensors.end() || index >= kMostSensors ? 0 : std::uint64_t{1} << index;
}

/// What a view brings to each of its joints, looked up once.
struct Source {
  const SensorView* view = nullptr;
  double weight = 0.0;
  NoiseModel noise;
  std::uint64_t contributor = 0;
};

std::vector<Source> sources_of(const Person& person, const std::vector<SensorId>& sensors,
                               const FusionConfig& config) {
  std::vector<Source> sources;
  for (const SensorView& view : person.views) {
    const auto own = config.sensor_noise.find(view.sensor);
    sources.push_back({&view, Weight::clamped(view.weight).value(),
                       own == config.sensor_noise.end() ? config.noise : own->second,
                       bit_of(view.sensor, sensors)});
  }
  return sources;
}

long tracked_joints(const SensorView& view) {
  const auto& joints = view.skeleton.joints;
  return std::count_if(joints.begin(), joints.end(),
                       [](const Joint& j) { return j.state == JointState::Tracked; });
}

/// Heaviest; then most tracked joints; then least sensor id, so that order never matters.
void keep_best(std::vector<Source>& sources) {
  const auto better = [](const Source& a, const Source& b) {
    const long joints_a = tracked_joints(*a.view);
    const long joints_b = tracked_joints(*b.view);
    return std::tie(a.weight, joints_a, b.view->sensor, b.view->body) <
           std::tie(b.weight, joints_b, a.view->sensor, a.view->body);
  };
  const auto best = std::max_element(sources.begin(), sources.end(), better);
  if (best != sources.end()) sources = {*best};
}

/// Decision 0007: when nobody who saw the joint has any weight, all of them have the same.
void lift_zero_weights(std::vector<Sighting>& sightings, double floor) {
  const bool any = std::any_of(sightings.begin(), sightings.end(),
                               [](const Sighting& s) { return s.weight > 0; });
  if (any) return;
  for (Sighting& s : sightings) s.weight = floor;
}

std::vector<Sighting> sightings_of(std::size_t joint, const std::vector<Source>& sources,
                                   Method method) {
  std::vector<Sighting> sightings;
  for (const Source& source : sources) {
    const Joint& seen = source.view->skeleton.joints[joint];
    if (!seen.seen()) continue;
    const double weight = method == Method::Otto ? source.weight : 1.0;
    sightings.push_back({seen, weight, source.view->eye, source.noise, source.contributor});
  }
  return sightings;
}

FusedJoint fuse_joint(std::size_t joint, const std::vector<Source>& sources,
                      const FusionConfig& config) {
  std::vector<Sighting> sightings = sightings_of(joint, sources, config.method);
  if (config.method == Method::Otto) lift_zero_weights(sightings, config.zero_weight_floor);
  FusedJoint fused = config.method == Method::InverseVariance
                         ? inverse_variance(sightings, config.huber)
                         : weighted_mean(sightings);
  if (fused.joint.seen()) fused.variance += config.common_sigma * config.common_sigma;
  return fused;
}

}  // namespace

std::string_view name_of(Method method) {
  for (const auto& [known, name] : kMethodNames) {
    if (known == method) return name;
  }
  return "unknown";
}

std::optional<Method> method_named(std::string_view name) {
  for (const auto& [method, known] : kMethodNames) {
    if (known == name) return method;
  }
  return std::nullopt;
}

FusedBody fuse(const Person& person, const std::vector<SensorId>& sensors,
               const FusionConfig& config) {
  std::vector<Source> sources = sources_of(person, sensors, config);
  if (config.method == Method::BestView) keep_best(sources);
  FusedBody body;
  body.id = person.id;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const FusedJoint fused = fuse_joint(i, sources, config);
    body.skeleton.joints[i] = fused.joint;
    body.variance[i] = fused.variance;
    body.contributors[i] = fused.contributors;
  }
  return body;
}

}  // namespace chorus::fusion
