// A workplace: points to reach, boxes (some of them in the way), props and who holds them when,
// from a small JSON file.  World space, metres.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/workplace/prop.h"

namespace chorus::workplace {

struct ScenePoint {
  std::string name;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();

  bool operator==(const ScenePoint&) const = default;
};

struct SceneBox {
  std::string name;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  double yaw = 0.0;       ///< About +y [rad].
  bool obstacle = false;  ///< Hands and looks do not pass through it.

  bool operator==(const SceneBox&) const = default;
};

/// A mark: from then on until then, somebody holds the prop.
struct HeldMark {
  std::size_t prop = 0;
  double from = 0.0;  ///< [s] since the recording's first frame
  double until = 0.0;
  std::optional<std::uint64_t> person;  ///< None: whoever is there.
};

struct Scene {
  std::string title;
  std::vector<ScenePoint> points;
  std::vector<SceneBox> boxes;
  std::vector<Prop> props;
  std::vector<HeldMark> held;
  /// Half of the cone that counts as seen [rad].  30 degrees is the wider of two cones in which
  /// displays are placed (EN 894-2: 15 recommended, 30 acceptable).
  double view = 0.5235987755982988;
};

/// Reads a scene; one error tells every mistake.  `origin` names the file.
[[nodiscard]] Result<Scene> read_scene(std::string_view text, std::string_view origin);

/// The share of the way from `a` to `b` at which the box is entered; none: it is not met.  A way
/// that begins inside enters at 0.
[[nodiscard]] std::optional<double> entered(const SceneBox& box, const Eigen::Vector3d& a,
                                            const Eigen::Vector3d& b);

/// The name of the first obstacle between two points, leaving out the last 5 cm, so that a point on
/// an obstacle's surface is not hidden by it; empty: none.
[[nodiscard]] std::string obstacle_between(const Scene& scene, const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b);

}  // namespace chorus::workplace
