// How the worn inertial sensors of one source sit on a person, as a document: in recordings on
// /inertial/{id}/calibration, and in files that a calibration is kept in.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/inertial/calibration.h"
#include "common/resource/node.h"

namespace chorus::resource {

/// Angles in radians; per sensor, by its name: limb, heading, mount (a quaternion
/// limb_from_sensor), the upper triangle of the covariance by rows, residual, predictionSigma.
[[nodiscard]] Node inertial_calibration_node(const inertial::InertialCalibration& calibration);
[[nodiscard]] std::string write(const inertial::InertialCalibration& calibration, Format format,
                                const Place& place = {});

/// Reads JSON or JSON-LD in that form.  Refuses limbs that do not exist, quaternions that are not
/// of unit length, negative variances, and more than inertial::kMaxInertialSensors sensors.
[[nodiscard]] Result<inertial::InertialCalibration> read_inertial_calibration(
    std::string_view bytes, Format format);

}  // namespace chorus::resource
