// Replaces ray bodies with flat figures while left and right are determined.
//
// Left and right are determined from positions (sides.h).  A camera without depth still shows how a
// body looks from the camera.  So its joints are put on the vertical plane through the person that
// faces the camera: their spans are then right except for the part along the line of sight.  Seen
// from the side, such a figure is too narrow to decide anything, and the sides stay as the camera
// reports them.
#pragma once

#include <vector>

#include "fusion-server/flow/person.h"

namespace chorus::facing {

struct Figure {
  std::size_t view = 0;  ///< Index in Person::views.
  bool narrow = false;
  Skeleton<WorldSpace> rays;  ///< The skeleton as the camera gave it.
};

/// Turns ray bodies into flat figures at `core` (world [m]).  A view whose camera is closer than
/// 0.3 m to the person stays as it is.
[[nodiscard]] std::vector<Figure> stand_in(Person& person, const Eigen::Vector3d& core);

/// Turns these views back into rays.  If left and right of a figure that is not narrow were swapped
/// in between, they stay swapped.  Changes to single limbs are discarded, because flat limbs are
/// too inaccurate for them.
void back_to_rays(Person& person, const std::vector<Figure>& figures);

}  // namespace chorus::facing
