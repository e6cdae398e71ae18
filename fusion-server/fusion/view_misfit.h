// What one view's body errs by as a whole: it is too large, or turned.
//
// A tracker that fits a body of its own proportions gets all bones of a frame wrong by one ratio;
// and one that sees a body from the side takes it to be turned towards itself (Otto et al. 3.2).
// Neither averages out over joints, so each is a nuisance of the view with a normal prior:
//   z_j = x_j + s (x_j - c) + t (up x (x_j - a_j)) + e_j                      docs/papers/body.md
//   (2)
// c the middle of the trunk, a_j the upper or lower end of the spine.
#pragma once

#include <array>

#include "common/body/skeleton.h"
#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/bone_tree.h"

namespace chorus::fusion {

/// One view's joints.
struct SeenBody {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< Where the sensor stands [m].
  std::array<Eigen::Vector3d, kJointCount> place{};
  std::array<double, kJointCount> variance{};  ///< Per axis [m^2]; 0: not seen as a point.
};

struct Misfit {
  double scale = 0.0;
  double turn = 0.0;  ///< About +y [rad].
};

/// The most likely one, given where the joints are, by one step from `before`; robust against
/// single joints.
[[nodiscard]] Misfit misfit_of(const SeenBody& seen, const PlacedBody& body, const Misfit& before,
                               const BodyModel& model);

/// The view's places without it.
[[nodiscard]] std::array<Eigen::Vector3d, kJointCount> mended(const SeenBody& seen,
                                                              const PlacedBody& body,
                                                              const Misfit& misfit);

}  // namespace chorus::fusion
