// The axis of a file's coordinates that points up (--up), and the turn into our axes.
#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

#include "common/base/result.h"

namespace chorus::importers {

struct UpAxis {
  int axis = 1;       ///< 0: x, 1: y, 2: z.
  bool down = false;  ///< The axis points down, as y does in a picture.
};

/// Reads "x", "y", "z", "-x", "-y" or "-z".
[[nodiscard]] Result<UpAxis> parse_up(std::string_view text);

[[nodiscard]] std::string to_string(const UpAxis& up);

/// The turn of a file's axes that makes this one +y.  For z: (x, y, z) -> (x, z, -y); for -y a half
/// turn about z, which makes camera axes (x right, y down, z ahead) those of our sensors.
[[nodiscard]] Eigen::Matrix3d ours_from_up(const UpAxis& up);

/// The axis along which `direction`, in the file's axes, points most.
[[nodiscard]] UpAxis up_along(const Eigen::Vector3d& direction);

}  // namespace chorus::importers
