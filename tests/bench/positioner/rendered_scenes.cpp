#include "tests/bench/positioner/rendered_scenes.h"

#include <cmath>
#include <random>

#include <opencv2/imgproc.hpp>

#include "common/geometry/rotation.h"
#include "common/importers/import_options.h"
#include "common/positioning/outline_sight.h"
#include "common/sensor/pixel_ray.h"
#include "common/synthetic/walker.h"

namespace chorus::bench {
namespace {

using enum JointId;

const Intrinsics kSceneLens{640, 480, 600.0, 600.0, 319.5, 239.5, {}};
constexpr int kEmptyPictures = 20;  // Of the room, before anybody comes.

/// Landmarks of a network, as they err on the eight real views (docs/benchmarks/positioner.md):
/// each has a constant offset from its joint, and an error that comes and goes.
class SimulatedLandmarks {
 public:
  explicit SimulatedLandmarks(std::uint64_t seed) : random_(seed) {
    for (auto& offset : offsets_) offset = 0.015 * normal3();
    for (auto& wander : wanders_) wander = 0.015 * normal3();
  }

  Skeleton<SensorSpace> of(const Skeleton<WorldSpace>& body, const Eigen::Isometry3d& camera) {
    Skeleton<WorldSpace> erring = body;
    const double kept = std::exp(-1.0 / (kSceneRate * 0.5));
    for (std::size_t i = 0; i < kJointCount; ++i) {
      wanders_[i] = kept * wanders_[i] + 0.015 * std::sqrt(1.0 - kept * kept) * normal3();
      erring.joints[i].position += offsets_[i] + wanders_[i];
    }
    Skeleton<SensorSpace> out = to_sensor(camera.inverse(), erring);
    for (Joint& joint : out.joints) {
      if (!joint.seen()) continue;
      joint.position = (joint.position.normalized() + 0.003 * normal3()).normalized();
      joint.measurement = Measurement::Ray;
      joint.covariance = {};
    }
    return out;
  }

 private:
  Eigen::Vector3d normal3() {
    std::normal_distribution<double> normal;
    const double x = normal(random_);
    const double y = normal(random_);
    return {x, y, normal(random_)};
  }

  std::mt19937_64 random_;
  std::array<Eigen::Vector3d, kJointCount> offsets_;
  std::array<Eigen::Vector3d, kJointCount> wanders_;
};

/// Share of the joints that something covers.
double covered(const Skeleton<WorldSpace>& body, const Eigen::Isometry3d& camera,
               const SceneCover& cover) {
  double hidden = 0.0;
  double all = 0.0;
  for (const Joint& joint : body.joints) {
    const auto pixel =
        pixel_of(camera_from_sensor_axes() * (camera.inverse() * joint.position), kSceneLens);
    if (!joint.seen() || !pixel) continue;
    all += 1.0;
    const double u = pixel->x() / kSceneLens.width;
    const double v = pixel->y() / kSceneLens.height;
    hidden += u > cover.left && u < cover.right && v > cover.top && v < cover.bottom ? 1.0 : 0.0;
  }
  return all > 0.0 ? hidden / all : 1.0;
}

/// A landmark that is covered, or outside of the picture, is guessed by a network; here it is
/// missing.
void hide(Skeleton<SensorSpace>& rays, const std::optional<SceneCover>& cover) {
  for (Joint& joint : rays.joints) {
    if (!joint.bears()) continue;
    const auto pixel = pixel_of(camera_from_sensor_axes() * joint.position, kSceneLens);
    const double u = pixel ? pixel->x() / kSceneLens.width : -1.0;
    const double v = pixel ? pixel->y() / kSceneLens.height : -1.0;
    const bool outside = !(u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0);
    const bool behind =
        cover && u > cover->left && u < cover->right && v > cover->top && v < cover->bottom;
    if (outside || behind) joint.state = JointState::NotTracked;
  }
}

ScenePicture scene_at(const SceneScript& script, const Skeleton<WorldSpace>& body,
                      const Eigen::Isometry3d& camera, double time) {
  ScenePicture out{camera, kSceneLens};
  out.people.push_back({body, script.girth, 40});
  if (script.stranger) {
    static const synthetic::Walker other({.seed = 99, .reach = 2.0, .body_scale = 1.05});
    out.people.push_back({other.at(from_seconds(time + 500.0)), 1.0, 60});
  }
  if (script.cover) out.cover = script.cover(time);
  out.light = script.light;
  out.seed = 1000 + static_cast<std::uint64_t>(kSceneRate * time);
  return out;
}

struct SceneView {
  std::shared_ptr<const RenderedScene> scene;
  Eigen::Isometry3d camera;
  positioning::SightCamera sight;
  silhouette::Background room{{.scale = positioning::kSightFieldScale}};
};

std::function<std::shared_ptr<const positioning::PictureSight>(std::size_t)> sights_of(
    const std::shared_ptr<const RenderedScene>& scene, const Eigen::Isometry3d& camera) {
  auto view = std::make_shared<SceneView>();
  view->scene = scene;
  view->camera = camera;
  view->sight = {camera, positioning::sight_lens(kSceneLens),
                 silhouette::usual_shape(kSceneStature)};
  for (int i = 0; i < kEmptyPictures; ++i)
    view->room.learn(picture_of({camera, kSceneLens, {}, {}, {}, static_cast<std::uint64_t>(i)}));
  return [view](std::size_t frame) -> std::shared_ptr<const positioning::PictureSight> {
    const double time = static_cast<double>(frame) / kSceneRate;
    auto evidence = view->room.evidence(
        picture_of(scene_at(view->scene->script, view->scene->truth[frame], view->camera, time)));
    if (!evidence) return nullptr;
    return positioning::outline_sight(view->sight, std::move(*evidence),
                                      {.search = view->scene->script.search});
  };
}

positioning::CameraTake camera_take(const RenderedScene& scene, std::size_t index) {
  const Eigen::Isometry3d& camera = scene.script.cameras[index];
  positioning::CameraTake take{
      SensorId::parse("cam0" + std::to_string(index + 1)).value(), camera, {}};
  SimulatedLandmarks landmarks(scene.script.seed + 10 * index);
  const double late = index == 1 ? scene.script.late : 0.0;
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    const double time = static_cast<double>(i) / kSceneRate;
    SensorFrame frame;
    frame.captured = importers::kDefaultStart + from_seconds(time + late);
    const auto cover = scene.script.cover ? scene.script.cover(time) : std::nullopt;
    Skeleton<SensorSpace> rays = landmarks.of(scene.truth[i], camera);
    hide(rays, cover);
    constexpr double kMostCovered = 0.7;  // Then a network finds nobody.
    if (!cover || covered(scene.truth[i], camera, *cover) < kMostCovered)
      frame.bodies.push_back({BodyId{1}, frame.captured, rays});
    take.frames.push_back(std::move(frame));
  }
  return take;
}

}  // namespace

Eigen::Isometry3d looking(const Eigen::Vector3d& from, const Eigen::Vector3d& at) {
  const Eigen::Vector3d z = (at - from).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() << x, z.cross(x), z;
  out.translation() = from;
  return out;
}

RenderedScene rendered_scene(SceneScript script) {
  RenderedScene out;
  out.script = std::move(script);
  const auto count = static_cast<std::size_t>(out.script.length * kSceneRate);
  for (std::size_t i = 0; i < count; ++i)
    out.truth.push_back(out.script.body(static_cast<double>(i) / kSceneRate));
  constexpr double kSuitRate = 60.0;
  std::vector<Skeleton<WorldSpace>> bodies;
  for (int i = 0; i < static_cast<int>(out.script.length * kSuitRate); ++i)
    bodies.push_back(out.script.body(i / kSuitRate));
  out.suit = suit_of(bodies, kSuitRate, out.script.suit);
  for (suit::SuitPose& pose : out.suit.poses) pose.time -= from_seconds(out.script.clock);
  for (std::size_t i = 0; i < out.script.cameras.size(); ++i)
    out.cameras.push_back(camera_take(out, i));
  const auto shared = std::make_shared<const RenderedScene>(out);
  for (std::size_t i = 0; i < out.cameras.size(); ++i)
    out.cameras[i].sight = sights_of(shared, out.script.cameras[i]);
  return out;
}

}  // namespace chorus::bench
