#include "fusion-server/facing/stand_in.h"

#include <algorithm>
#include <utility>

#include "common/body/bones.h"
#include "fusion-server/facing/lateral.h"

namespace chorus::facing {
namespace {

constexpr double kNearest = 0.3;  // [m], horizontal; a person is not nearer to a camera.
// A figure is narrow if the size_of() its spans is less than this [m]; a person seen from the front
// has about 0.8.
constexpr double kWide = 0.35;
// Cosine of the angle between ray and normal; a flatter ray meets the plane too far away.
constexpr double kSteepest = 0.1;

/// Moves the joint to where its ray meets the plane; if the ray is too flat, the joint stays a ray.
void put_on_plane(Joint& joint, const Eigen::Vector3d& eye, const Eigen::Vector3d& normal,
                  double range) {
  if (!joint.bears()) return;
  const double cosine = normal.dot(joint.position);
  if (cosine < kSteepest) return;
  joint.measurement = Measurement::Point;
  joint.position = eye + range / cosine * joint.position;
}

/// True if most of the complete pairs lie on the rays of the opposite joints.
bool is_exchanged(const SensorView& view, const Skeleton<WorldSpace>& rays) {
  int exchanged = 0;
  for (const auto& [left, right] : kMirrorPairs) {
    if (!view.skeleton[left].seen() || !rays[left].bears() || !rays[right].bears()) continue;
    const Eigen::Vector3d now = (view.skeleton[left].position - view.eye).normalized();
    const bool crossed = (now - rays[right].position).norm() < (now - rays[left].position).norm();
    exchanged += crossed ? 1 : -1;
  }
  return exchanged > 0;
}

}  // namespace

std::vector<Figure> stand_in(Person& person, const Eigen::Vector3d& core) {
  std::vector<Figure> figures;
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    SensorView& view = person.views[v];
    if (!has_rays_alone(view.skeleton.joints) || !view.eye.allFinite()) continue;
    Eigen::Vector3d normal = core - view.eye;
    normal.y() = 0;
    const double range = normal.norm();
    if (!(range > kNearest)) continue;
    Figure figure{v, false, view.skeleton};
    for (Joint& joint : view.skeleton.joints) put_on_plane(joint, view.eye, normal / range, range);
    figure.narrow = size_of(spans_of(view.skeleton)) < kWide;
    figures.push_back(std::move(figure));
  }
  return figures;
}

void back_to_rays(Person& person, const std::vector<Figure>& figures) {
  for (const Figure& figure : figures) {
    SensorView& view = person.views[figure.view];
    const bool exchanged = !figure.narrow && is_exchanged(view, figure.rays);
    view.skeleton = figure.rays;
    if (!exchanged) continue;
    for (const auto& [left, right] : kMirrorPairs)
      std::swap(view.skeleton[left], view.skeleton[right]);
  }
}

}  // namespace chorus::facing
