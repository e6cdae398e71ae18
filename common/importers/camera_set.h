// Calibrated cameras as they are published with a recording: intrinsics and extrinsics of each.
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Geometry>

#include "common/importers/import_options.h"
#include "common/sensor/camera_image.h"

namespace chorus::importers {

struct CalibratedCamera {
  SensorId sensor;
  Intrinsics intrinsics;
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();  ///< In our world's axes.
};

/// Reads [{"camera", "width", "height", "K": 3x3, "distortion_k1k2p1p2k3": 5, "camera_from_world":
/// {"R": 3x3, "t_m": 3}}], with OpenCV camera axes and world z up.
/// Refuses an R that is not a rotation, repeated names, and more than 64 cameras.
[[nodiscard]] Result<std::vector<CalibratedCamera>> read_cameras(const std::filesystem::path& file,
                                                                 const ImportLimits& limits = {});

/// Turns a z-up world (floor z = 0) about x into ours (+y up): (x, y, z) -> (x, z, -y).
[[nodiscard]] Eigen::Matrix3d world_from_z_up();

}  // namespace chorus::importers
