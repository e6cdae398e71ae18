// Internal to common/resource: the names of an inertial reading's numbers in JSON.
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "common/inertial/inertial_frame.h"

namespace chorus::resource {

/// Beyond anything that a worn sensor measures, in any of our units.
inline constexpr double kLargestMember = 1e6;

/// The members of a reading that are vectors, which of its axes each is about, and its decimals.
struct VectorField {
  std::optional<Eigen::Vector3d> inertial::InertialReading::*value;
  std::array<const char*, 3> keys;
  int digits;
};
inline constexpr std::array kVectors{
    VectorField{&inertial::InertialReading::acceleration,
                {"accelerationX", "accelerationY", "accelerationZ"},
                5},
    VectorField{&inertial::InertialReading::free_acceleration,
                {"freeAccelerationX", "freeAccelerationY", "freeAccelerationZ"},
                5},
    VectorField{
        &inertial::InertialReading::rate, {"angularRateX", "angularRateY", "angularRateZ"}, 5},
    VectorField{&inertial::InertialReading::field,
                {"magneticFieldX", "magneticFieldY", "magneticFieldZ"},
                4},
};
inline constexpr std::array<const char*, 4> kQuaternion{"qx", "qy", "qz", "qw"};
/// Upper triangle, by rows.
inline constexpr std::array<const char*, 6> kCovariance{"rxx", "rxy", "rxz", "ryy", "ryz", "rzz"};
inline constexpr std::array<std::pair<int, int>, 6> kTriangle{
    {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

}  // namespace chorus::resource
