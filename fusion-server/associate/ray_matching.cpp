#include "fusion-server/associate/ray_matching.h"

#include <algorithm>
#include <span>
#include <utility>

#include "common/base/median.h"
#include "common/body/bones.h"
#include "common/geometry/ray.h"

namespace chorus::associate {
namespace {

constexpr std::size_t kEnough = 3;  // Number of joints needed to decide.
// Number of joints that rays of two cameras must locate to start a new person: rays of a few joints
// of two people meet by chance.
constexpr std::ptrdiff_t kLeast = 5;
constexpr std::size_t kMaxNew = 64;     // Views considered at one instant; the others have to wait.
constexpr std::size_t kMaxPairs = 256;  // Hypotheses considered, best first.

Ray ray_of(const SensorView& view, JointId joint) {
  return {view.eye, view.skeleton[joint].position};
}

std::optional<double> median_of(std::vector<double> values) {
  if (values.size() < kEnough) return std::nullopt;
  return median(std::move(values));
}

/// Median distance [m] between the two views' rays, over the joints that both show as rays.
std::optional<double> apart(const SensorView& a, const SensorView& b) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    if (!a.skeleton[id].bears() || !b.skeleton[id].bears()) continue;
    if (const auto gap = distance(ray_of(a, id), ray_of(b, id))) distances.push_back(*gap);
  }
  return median_of(std::move(distances));
}

/// True if enough of the body is located, and a person can be that far from each camera and of that
/// size.
bool is_plausible(const Located& body, std::span<const PlacedView> views,
                  const BodyLimits& limits) {
  const auto core = middle_of(body);
  const auto is_located = [](const auto& joint) { return joint.has_value(); };
  if (!core || std::ranges::count_if(body, is_located) < kLeast) return false;
  for (const PlacedView& each : views) {
    if ((*core - each.view.eye).norm() > limits.max_range) return false;
  }
  double reach = 0.0;
  for (const auto& joint : body) {
    if (joint) reach = std::max(reach, (*joint - *core).norm());
  }
  return reach >= limits.min_reach && reach <= limits.max_reach;
}

/// Two views that may show the same person, and all other views that agree with them.
struct Hypothesis {
  std::vector<std::size_t> views;  ///< Indices of the views, at most one per sensor.
  double misfit = 0.0;             ///< How far its rays miss each other [m]; less is better.
};

/// Adds, for every other sensor, the view that fits best, if it fits well enough.
void add_supporters(Hypothesis& found, const std::vector<PlacedView>& views, const Located& body,
                    double limit) {
  struct Supporter {
    std::size_t view = 0;
    double misfit = 0.0;
  };
  std::map<SensorId, Supporter> best;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto off = misfit(views[i].view, body, Eigen::Vector3d::Zero());
    if (!off || *off > limit) continue;
    const auto [known, fresh] = best.try_emplace(views[i].view.sensor, Supporter{i, *off});
    if (!fresh && *off < known->second.misfit) known->second = {i, *off};
  }
  for (const std::size_t member : found.views) best.erase(views[member].view.sensor);
  for (const auto& [sensor, supporter] : best) {
    found.views.push_back(supporter.view);
    found.misfit += supporter.misfit;
  }
  found.misfit /= static_cast<double>(found.views.size());
}

std::vector<Hypothesis> pairs_of(const std::vector<PlacedView>& views, double limit) {
  std::vector<Hypothesis> pairs;
  for (std::size_t a = 0; a < views.size(); ++a) {
    for (std::size_t b = a + 1; b < views.size(); ++b) {
      if (views[a].view.sensor == views[b].view.sensor) continue;
      const auto off = apart(views[a].view, views[b].view);
      if (off && *off <= limit) pairs.push_back({{a, b}, *off});
    }
  }
  std::ranges::stable_sort(pairs, {}, &Hypothesis::misfit);
  if (pairs.size() > kMaxPairs) pairs.resize(kMaxPairs);
  return pairs;
}

std::vector<Hypothesis> hypotheses_of(const std::vector<PlacedView>& views, double limit,
                                      const BodyLimits& bodies) {
  std::vector<Hypothesis> plausible;
  for (Hypothesis& pair : pairs_of(views, limit)) {
    const std::vector<PlacedView> two{views[pair.views[0]], views[pair.views[1]]};
    const Located body = locate(two);
    if (!is_plausible(body, two, bodies)) continue;
    add_supporters(pair, views, body, limit);
    plausible.push_back(std::move(pair));
  }
  std::ranges::stable_sort(plausible, [](const Hypothesis& a, const Hypothesis& b) {
    if (a.views.size() != b.views.size()) return a.views.size() > b.views.size();
    return a.misfit < b.misfit;
  });
  return plausible;
}

}  // namespace

Located locate(const std::vector<PlacedView>& views) {
  Located body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double points = 0.0;
    std::vector<Ray> rays;
    for (const PlacedView& each : views) {
      const Joint& joint = each.view.skeleton.joints[i];
      if (joint.bears()) rays.push_back({each.view.eye, joint.position});
      if (!joint.seen()) continue;
      sum += joint.position;
      points += 1.0;
    }
    body[i] = points > 0 ? std::optional<Eigen::Vector3d>(sum / points) : meeting_point(rays);
  }
  return body;
}

std::optional<double> misfit(const SensorView& view, const Located& body,
                             const Eigen::Vector3d& shift) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!view.skeleton.joints[i].bears() || !body[i]) continue;
    distances.push_back(distance(ray_of(view, static_cast<JointId>(i)), *body[i] + shift));
  }
  return median_of(std::move(distances));
}

std::optional<double> misfit(const SensorView& view, const Eigen::Vector3d& core) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const JointId id : kCoreJoints) {
    if (view.skeleton[id].bears()) sum += view.skeleton[id].position;
  }
  if (sum.norm() == 0.0) return std::nullopt;
  return distance(Ray{view.eye, sum.normalized()}, core);
}

std::vector<std::vector<PlacedView>> meet(std::vector<PlacedView> views, double limit,
                                          const BodyLimits& bodies) {
  if (views.size() > kMaxNew) views.resize(kMaxNew);
  std::vector<std::vector<PlacedView>> people;
  std::vector<bool> taken(views.size(), false);
  for (const Hypothesis& each : hypotheses_of(views, limit, bodies)) {
    const auto is_taken = [&](std::size_t view) { return taken[view]; };
    if (std::ranges::any_of(each.views, is_taken)) continue;
    auto& person = people.emplace_back();
    for (const std::size_t view : each.views) {
      taken[view] = true;
      person.push_back(views[view]);
    }
  }
  return people;
}

}  // namespace chorus::associate
