#include "tests/bench/methods/averaging.h"

#include <algorithm>
#include <utility>

namespace chorus::bench::baselines {
namespace {

bool tracked(const Joint& joint) { return joint.state == JointState::Tracked; }

Joint mean_joint(const std::vector<Joint>& sights, const std::vector<std::size_t>& members) {
  Joint mean;
  for (const std::size_t i : members) {
    mean.position += sights[i].position / static_cast<double>(members.size());
    mean.state = std::max(mean.state, sights[i].state);
  }
  return mean;
}

double spread(const std::vector<Eigen::Vector3d>& points, const std::vector<std::size_t>& members) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const std::size_t i : members) centre += points[i] / static_cast<double>(members.size());
  double sum = 0.0;
  for (const std::size_t i : members) sum += (points[i] - centre).squaredNorm();
  return sum;
}

/// All points that can be reached from `start` by steps of at most `reach`; they are removed from
/// `left`.
std::vector<std::size_t> reached_from(std::size_t start, const std::vector<Eigen::Vector3d>& points,
                                      double reach, std::vector<std::size_t>& left) {
  std::vector<std::size_t> members{start};
  for (std::size_t next = 0; next < members.size(); ++next) {
    const Eigen::Vector3d from = points[members[next]];
    const auto near = std::partition(
        left.begin(), left.end(), [&](std::size_t i) { return (points[i] - from).norm() > reach; });
    members.insert(members.end(), near, left.end());
    left.erase(near, left.end());
  }
  return members;
}

}  // namespace

Method product(fusion::FusionConfig config) {
  return [config = std::move(config), memory = fusion::Memory(), sensors = std::vector<SensorId>()](
             const Person& person, Timestamp instant) mutable {
    for (const SensorView& view : person.views) {
      if (std::ranges::count(sensors, view.sensor) == 0) sensors.push_back(view.sensor);
    }
    return memory.fuse({person}, {instant, sensors}, config).front().skeleton;
  };
}

Method product(fusion::Method method) {
  fusion::FusionConfig config;
  config.method = method;
  return product(std::move(config));
}

Method tracked_mean() {
  return [mean = product(fusion::Method::Mean)](const Person& person, Timestamp instant) {
    Person kept = person;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const bool any = std::ranges::any_of(
          person.views, [i](const SensorView& v) { return tracked(v.skeleton.joints[i]); });
      for (SensorView& view : kept.views) {
        Joint& joint = view.skeleton.joints[i];
        if (any && !tracked(joint)) joint = Joint{};
      }
    }
    return mean(kept, instant);
  };
}

std::vector<std::vector<std::size_t>> clusters_of(const std::vector<Eigen::Vector3d>& points,
                                                  double reach) {
  std::vector<std::size_t> left;
  for (std::size_t i = points.size(); i-- > 0;) left.push_back(i);
  std::vector<std::vector<std::size_t>> clusters;
  while (!left.empty()) {
    const std::size_t start = left.back();
    left.pop_back();
    clusters.push_back(reached_from(start, points, reach, left));
  }
  std::ranges::stable_sort(clusters, [&](const auto& a, const auto& b) {
    if (a.size() != b.size()) return a.size() > b.size();
    return spread(points, a) < spread(points, b);
  });
  return clusters;
}

Method largest_cluster() {
  return [](const Person& person, Timestamp) {
    Body body;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      std::vector<Joint> sights;
      std::vector<Eigen::Vector3d> points;
      for (const SensorView& view : person.views) {
        if (!view.skeleton.joints[i].seen()) continue;
        sights.push_back(view.skeleton.joints[i]);
        points.push_back(sights.back().position);
      }
      const auto clusters = clusters_of(points, kClusterReach);
      if (!clusters.empty()) body.joints[i] = mean_joint(sights, clusters.front());
    }
    return body;
  };
}

}  // namespace chorus::bench::baselines
