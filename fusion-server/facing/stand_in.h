// Bodies that are rays alone, made flat figures while left and right are settled.
//
// Which side is which is told from places (sides.h).  A camera without depth still shows how a body
// looks from where it stands, so its joints are put on the upright plane through the person that
// faces the camera: their spans are right but for what lies along the line of sight.  Seen from the
// side a figure is too narrow to tell anything, and is believed to have its sides as the camera
// says.
#pragma once

#include <vector>

#include "fusion-server/flow.h"

namespace chorus::facing {

struct Figure {
  std::size_t view = 0;  ///< Index.
  bool narrow = false;
  Skeleton<WorldSpace> rays;  ///< What it was.
};

/// Turns the views of rays alone into flat figures at `core` (world [m]).  Views whose camera is in
/// the person stay as they are.
[[nodiscard]] std::vector<Figure> stand_in(Person& person, const Eigen::Vector3d& core);

/// Turns those views back into rays.  Wide figures whose sides were exchanged meanwhile stay
/// exchanged; what was said of single limbs is dropped, because flat limbs are too far off for
/// that.
void back_to_rays(Person& person, const std::vector<Figure>& figures);

}  // namespace chorus::facing
