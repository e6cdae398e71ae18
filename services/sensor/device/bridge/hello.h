// What a pusher says about itself before it pushes frames (proto/bridge.md, section 2).
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "common/layout/layout.h"
#include "common/sensor/camera_image.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::bridge {

struct Hello {
  std::string name;                        ///< 1 to 64 printable ASCII characters.
  const layout::Layout* layout = nullptr;  ///< Not null after read_hello().
  /// Turns the pusher's axes into ours; a reflection when the pusher's axes are left-handed.
  Eigen::Matrix3d sensor_from_pusher = Eigen::Matrix3d::Identity();
  std::optional<FloorPlane> floor;    ///< The floor in sensor space.
  std::optional<Intrinsics> camera;   ///< The camera of the pixels that the pusher sends.
  std::optional<double> pixel_sigma;  ///< Standard deviation of a pixel coordinate [px].
  double focal_sigma = 0.0;           ///< Standard deviation of the focal length, relative to it.
  double tracked_from = 0.0;          ///< Confidence, as in Layout.
  double inferred_from = 0.0;
};

/// Parses "right down ahead": the directions in which x, y and z point, as seen when looking in the
/// camera's direction.
[[nodiscard]] Result<Eigen::Matrix3d> read_axes(std::string_view words);

/// Reads the floor n.x + d = 0 from nx, ny, nz, d in the pusher's axes [m]; the normal must point
/// up, and the camera must not be below the floor.
[[nodiscard]] Result<FloorPlane> read_floor(const nlohmann::json& value,
                                            const Eigen::Matrix3d& sensor_from_pusher);

[[nodiscard]] Result<Hello> read_hello(const nlohmann::json& message);

}  // namespace chorus::bridge
