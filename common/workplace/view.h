// What is in somebody's view: a cone about where the head points.
//
// A head whose orientation no sensor knows points where the shoulders do, give or take 30 degrees
// of its turns; `assumed` says so.  Eyes are not seen, so looks out of the corner are not known.
#pragma once

#include <string>

#include "common/body/skeleton.h"
#include "common/workplace/scene.h"

namespace chorus::workplace {

struct Gaze {
  bool known = false;
  bool assumed = false;  ///< By the shoulders.
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double sigma = 0.0;  ///< Of the direction [rad].
};

/// `turn`: covariance of the head's orientation [rad^2], if known.
[[nodiscard]] Gaze gaze_of(const Skeleton<WorldSpace>& body, const Covariance& turn = {});

struct Seen {
  double angle = 0.0;        ///< From the middle of the view [rad].
  double probability = 0.0;  ///< That it lies in the cone, whatever hides it.
  std::string hidden_by{};   ///< The obstacle in between; empty: none.
};

[[nodiscard]] Seen sight_of(const Gaze& gaze, const Eigen::Vector3d& point, const Scene& scene);

}  // namespace chorus::workplace
