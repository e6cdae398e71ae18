// Refuses bodies that cannot be meant as they are sent: the usual mistakes of pushers.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "common/body/skeleton.h"
#include "common/sensor/camera_image.h"
#include "services/sensor/device/bridge/json_value.h"

namespace chorus::bridge {

/// Refuses a body of which every point is too far away.  Single points may be, since depth cameras
/// measure some wrongly.
[[nodiscard]] Result<void> check_distance(const Skeleton<SensorSpace>& skeleton, const At& at);

/// The places of the landmarks in `pixels`, which has been read without an error [px].
[[nodiscard]] std::vector<Eigen::Vector2d> pixels_given(const nlohmann::json& pixels);

/// Refuses normalised coordinates, which would all be rays through one corner of the picture.
[[nodiscard]] Result<void> check_pixels(const std::vector<Eigen::Vector2d>& pixels, const At& at);

/// Whether all landmarks lie outside the picture; none if there are too few to tell.
[[nodiscard]] std::optional<bool> outside_picture(const std::vector<Eigen::Vector2d>& pixels,
                                                  const Intrinsics& camera);

}  // namespace chorus::bridge
