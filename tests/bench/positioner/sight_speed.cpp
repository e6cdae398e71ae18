// How long a picture takes, in a region of interest and whole, and whether the places agree.
#include <ctime>

#include <opencv2/core.hpp>

#include "common/positioning/outline_sight.h"
#include "common/synthetic/walker.h"
#include "tests/bench/positioner/positioner_cases.h"
#include "tests/bench/positioner/rendered_scenes.h"

namespace chorus::bench {
namespace {

using positioning::ExpectedBody;
using positioning::PictureSight;
using positioning::SightedPlace;

const Intrinsics kSpeedLens{640, 480, 600.0, 600.0, 319.5, 239.5, {}};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Pictures of somebody who walks, before a room that is known.
struct SpeedScene {
  Eigen::Isometry3d camera = looking({0, 2.0, 4.6}, {0, 0.9, 0});
  positioning::SightCamera sight{camera, positioning::sight_lens(kSpeedLens),
                                 silhouette::usual_shape(kSceneStature)};
  std::vector<Skeleton<WorldSpace>> bodies = {};
  std::vector<silhouette::EvidenceSource> sources = {};
  double subtraction_s = 0.0;  ///< Of one picture.
};

SpeedScene speed_scene(std::uint64_t seed, std::size_t pictures) {
  SpeedScene out;
  silhouette::Background room({.scale = positioning::kSightFieldScale});
  for (std::uint64_t i = 0; i < 20; ++i)
    room.learn(picture_of({out.camera, kSpeedLens, {}, {}, {}, i}));
  const synthetic::Walker walker({.seed = seed, .reach = 1.4});
  for (std::size_t i = 0; i < pictures; ++i) {
    out.bodies.push_back(walker.at(from_seconds(10.0 + 0.4 * static_cast<double>(i))));
    const cv::Mat picture =
        picture_of({out.camera, kSpeedLens, {{out.bodies.back(), 1.08, 40}}, {}, {}, 1000 + i});
    if (i == 0) (void)room.evidence(picture);  // The median is made once.
    const double before = processor_seconds();
    if (auto source = room.evidence(picture)) out.sources.push_back(std::move(*source));
    out.subtraction_s += processor_seconds() - before;
  }
  out.subtraction_s /= static_cast<double>(std::max<std::size_t>(1, pictures));
  return out;
}

struct SpeedResult {
  double seconds = 0.0;  ///< Of a picture.
  std::vector<std::optional<SightedPlace>> places = {};
};

using AskSight = std::optional<SightedPlace> (PictureSight::*)(const ExpectedBody&) const;

SpeedResult asked(const SpeedScene& scene, AskSight ask, bool regions) {
  positioning::SightSettings settings;
  settings.regions = regions;
  SpeedResult out;
  const double before = processor_seconds();
  for (std::size_t i = 0; i < scene.sources.size(); ++i) {
    const auto sight = positioning::outline_sight(scene.sight, scene.sources[i], settings);
    const suit::SuitPose pose = suit::pose_of(scene.bodies[i], Duration{0});
    const Eigen::Vector3d expected =
        scene.bodies[i][JointId::SpineBase].position + Eigen::Vector3d(0.06, 0.0, -0.08);
    out.places.push_back(((*sight).*ask)({pose, 0.0, expected}));
  }
  out.seconds = (processor_seconds() - before) /
                static_cast<double>(std::max<std::size_t>(1, scene.sources.size()));
  return out;
}

/// Threshold, Canny and distance transform alone, of one picture [s].
double field_seconds(const SpeedScene& scene, bool regions) {
  const double before = processor_seconds();
  for (std::size_t i = 0; i < scene.sources.size(); ++i) {
    const silhouette::SearchView view{scene.bodies[i], scene.sight.shape, scene.camera,
                                      scene.sight.lens, silhouette::Evidence{}};
    const auto region = silhouette::region_around(view, 0.25);
    if (regions && region) {
      (void)scene.sources[i].within(*region);
    } else {
      (void)scene.sources[i].whole();
    }
  }
  return (processor_seconds() - before) / static_cast<double>(scene.sources.size());
}

/// Largest distance of two methods' places; a picture that only one of them answers counts as 1 m.
double farthest_apart(const SpeedResult& a, const SpeedResult& b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    if (a.places[i].has_value() != b.places[i].has_value()) return 1.0;
    if (a.places[i]) out = std::max(out, (a.places[i]->place - b.places[i]->place).norm());
  }
  return out;
}

}  // namespace

Result<void> sight_speed(Report& report) {
  const SpeedScene scene = speed_scene(report.seed() + 2, report.quick() ? 5 : 60);
  report.row("speed/background", "cpu_ms", 1e3 * scene.subtraction_s, "ms");
  const auto row = [&](const std::string& name, AskSight ask) {
    const SpeedResult whole = asked(scene, ask, false);
    const SpeedResult part = asked(scene, ask, true);
    report.row("speed/" + name + "-whole", "cpu_ms", 1e3 * whole.seconds, "ms");
    report.row("speed/" + name + "-region", "cpu_ms", 1e3 * part.seconds, "ms", "whole",
               part.seconds / whole.seconds);
    report.row("speed/" + name + "-region", "farthest_from_whole_mm",
               1e3 * farthest_apart(part, whole), "mm");
  };
  const double whole = field_seconds(scene, false);
  const double part = field_seconds(scene, true);
  report.row("speed/field-whole", "cpu_ms", 1e3 * whole, "ms");
  report.row("speed/field-region", "cpu_ms", 1e3 * part, "ms", "whole", part / whole);
  row("silhouettes", &PictureSight::searched);
  row("outline", &PictureSight::outlined);
  report.note("speed: 640 x 480, one thread; the time of whichever build runs this");
  return {};
}

}  // namespace chorus::bench
