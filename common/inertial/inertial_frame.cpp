#include "common/inertial/inertial_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace chorus::inertial {
namespace {

constexpr std::array<std::string_view, 4> kStateNames{"unknown", "undisturbed", "disturbed",
                                                      "none"};

// A quaternion written with two digits is off by at most this; one that is further off is damaged.
constexpr double kNormTolerance = 0.05;

bool is_printable(std::string_view name) {
  return std::ranges::all_of(name, [](char c) { return c >= 0x20 && c != 0x7f; });
}

bool all_finite(const InertialReading& each) {
  const auto fine = [](const std::optional<Eigen::Vector3d>& v) { return !v || v->allFinite(); };
  return fine(each.acceleration) && fine(each.free_acceleration) && fine(each.rate) &&
         fine(each.field) && (!each.covariance || each.covariance->allFinite()) &&
         (!each.battery || std::isfinite(*each.battery));
}

Result<void> check_name(const std::string& name) {
  if (!name.empty() && name.size() <= kMaxSensorName && is_printable(name)) return {};
  return fail(ErrorCode::Malformed, "sensor \"" + name.substr(0, kMaxSensorName) + "\"",
              "a sensor's name has 1 to 64 printable characters");
}

Result<void> check_reading(InertialReading& each) {
  if (auto ok = check_name(each.sensor); !ok) return ok;
  if (!all_finite(each))
    return fail(ErrorCode::Malformed, "sensor " + each.sensor,
                "holds a number that is not finite; leave out what is not measured");
  if (!each.inertial_from_sensor) return {};
  const double norm = each.inertial_from_sensor->coeffs().norm();
  if (!(std::abs(norm - 1.0) <= kNormTolerance))
    return fail(ErrorCode::Malformed, "sensor " + each.sensor,
                "its quaternion is not of unit length; leave out an orientation that is not known");
  each.inertial_from_sensor->coeffs() /= norm;
  return {};
}

}  // namespace

std::string_view name_of(MagneticState state) noexcept {
  return kStateNames[static_cast<std::size_t>(state)];
}

std::optional<MagneticState> magnetic_state_named(std::string_view name) {
  const auto found = std::ranges::find(kStateNames, name);
  if (found == kStateNames.end()) return std::nullopt;
  return static_cast<MagneticState>(found - kStateNames.begin());
}

Eigen::Quaterniond y_up_from_z_up() { return {0.5, -0.5, -0.5, -0.5}; }

Result<InertialFrame> checked(InertialFrame frame) {
  if (frame.readings.size() > kMaxInertialSensors)
    return fail(ErrorCode::TooLarge, frame.source.str(),
                "has " + std::to_string(frame.readings.size()) + " sensors; at most 64 are read");
  std::set<std::string_view> names;
  for (InertialReading& each : frame.readings) {
    if (auto ok = check_reading(each); !ok) return pass(ok);
    if (!names.insert(each.sensor).second)
      return fail(ErrorCode::Conflict, "sensor " + each.sensor,
                  "is there twice; give each sensor a name of its own");
  }
  return frame;
}

}  // namespace chorus::inertial
