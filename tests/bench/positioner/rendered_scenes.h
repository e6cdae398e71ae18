// Rendered scenes: real steps (a CMU walk) along a path, a suit that errs, pictures of another body
// than the method's, landmarks with errors that stay, and the truth.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/positioning/take.h"
#include "common/silhouette/search.h"
#include "tests/bench/positioner/scene_pictures.h"
#include "tests/bench/positioner/suit_stand_in.h"

namespace chorus::bench {

struct SceneScript {
  std::string name;
  /// The body at a time [s].
  std::function<Skeleton<WorldSpace>(double time)> body;
  double length = 16.0;  ///< [s]
  std::vector<Eigen::Isometry3d> cameras;
  SuitErrors suit{.bone = 0.0349, .size = 1.02, .heading = 0.0873};  ///< 2 degrees, 2 %, 5 degrees.
  double clock = 0.04;  ///< The suit's time is so much too small [s].
  double girth = 1.08;  ///< Of the person in the pictures.
  double late = 0.0;    ///< Of the second camera's clock [s].
  /// What is before the person at a time; none: nothing.
  std::function<std::optional<SceneCover>(double time)> cover = {};
  SceneLight light = {};                ///< While people are there; the empty room is without.
  bool stranger = false;                ///< A second person walks about.
  silhouette::SearchSettings search{};  ///< Of the paper's method.
  std::uint64_t seed = 1;
};

struct RenderedScene {
  SceneScript script;
  std::vector<Skeleton<WorldSpace>> truth;  ///< At each picture.
  suit::SuitTake suit;
  std::vector<positioning::CameraTake> cameras;
};

inline constexpr double kSceneRate = 30.0;  ///< [Hz]
inline constexpr double kSceneStature =
    1.7;  ///< That the method is told; the suit's bones say more.

/// Renders nothing yet: pictures are made when a method asks for them.
[[nodiscard]] RenderedScene rendered_scene(SceneScript script);

/// Camera axes from a place that looks at another.
[[nodiscard]] Eigen::Isometry3d looking(const Eigen::Vector3d& from, const Eigen::Vector3d& at);

}  // namespace chorus::bench
