#include "common/importers/up_axis.h"

#include <cmath>

namespace chorus::importers {

Result<UpAxis> parse_up(std::string_view text) {
  const bool down = text.starts_with('-');
  const std::string_view name = text.substr(down ? 1 : 0);
  const std::size_t axis = std::string_view("xyz").find(name);
  if (name.size() != 1 || axis == std::string_view::npos)
    return fail(ErrorCode::InvalidArgument, "--up",
                "must be x, y or z: the axis of the file that points up; -y if it points down");
  return UpAxis{static_cast<int>(axis), down};
}

std::string to_string(const UpAxis& up) {
  return (up.down ? "-" : "") + std::string(1, "xyz"[up.axis]);
}

Eigen::Matrix3d ours_from_up(const UpAxis& up) {
  const double sign = up.down ? -1.0 : 1.0;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (up.axis == 1) {
    if (up.down) turn = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  } else if (up.axis == 2) {
    turn << 1, 0, 0, 0, 0, sign, 0, -sign, 0;
  } else {
    turn << 0, -sign, 0, sign, 0, 0, 0, 0, 1;
  }
  return turn;
}

UpAxis up_along(const Eigen::Vector3d& direction) {
  UpAxis up;
  direction.cwiseAbs().maxCoeff(&up.axis);
  up.down = direction[up.axis] < 0.0;
  return up;
}

}  // namespace chorus::importers
