// The lens of a camera in a file, as `chorus calibrate camera` writes it.
#pragma once

#include <string>
#include <vector>

#include "services/sensor/device/camera/lens.h"

namespace chorus::ctl {

/// Reads the keys of device.camera.intrinsics, or a sensor's configuration that contains them.  All
/// other settings have their defaults.
[[nodiscard]] Result<camera::CameraSettings> read_lens_file(const std::string& file);

/// Reads such a file as a Lens, for pictures of the size that it states.
[[nodiscard]] Result<camera::Lens> lens_in(const std::string& file);

/// InvalidArgument unless there are no lenses, one for all inputs, or one for each.
[[nodiscard]] Result<void> check_lens_count(const std::vector<std::string>& lenses,
                                            std::size_t inputs);

}  // namespace chorus::ctl
