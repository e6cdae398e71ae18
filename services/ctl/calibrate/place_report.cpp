#include "services/ctl/calibrate/place_report.h"

#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::ctl {
namespace {

using calibration::PredictedError;

/// The direction in which the camera looks, as degrees from +z towards +x, and downwards.
std::pair<double, double> direction_of(const calibration::CameraPlace& place) {
  const Eigen::Vector3d ahead = place.world_from_sensor.linear().col(2);
  return {to_deg(std::atan2(ahead.x(), ahead.z())),
          to_deg(std::asin(std::min(1.0, std::max(-1.0, -ahead.y()))))};
}

double position_sigma(const calibration::CameraPlace& place) {
  return std::sqrt(place.covariance.bottomRightCorner<3, 3>().trace());
}

double turn_sigma(const calibration::CameraPlace& place) {
  return std::sqrt(place.covariance.topLeftCorner<3, 3>().trace());
}

}  // namespace

std::string place_text(const PlaceOutcome& outcome) {
  const calibration::CameraPlace& place = outcome.place;
  const Eigen::Vector3d& at = place.world_from_sensor.translation();
  const auto [yaw, down] = direction_of(place);
  std::string out = fmt::format(
      "{} stands at x {:.3f}, y {:.3f} (above the floor), z {:.3f} m, give or take {:.0f} mm and "
      "{:.2f} deg\nlooks {:.1f} deg from +z towards +x, {:.1f} deg down; the points are {:.2f} px "
      "from their places ({} sight{})\n",
      outcome.sensor, at.x(), at.y(), at.z(), to_mm(position_sigma(place)),
      to_deg(turn_sigma(place)), yaw, down, place.error_px, place.sights,
      place.sights == 1 ? "" : "s");
  out += "so a person would be misplaced by, as a standard deviation:\n";
  for (const PredictedError& error : outcome.errors) {
    out += fmt::format(
        "  at ({:5.1f}, {:5.1f}) m: {}\n", error.point.x(), error.point.z(),
        error.seen ? fmt::format("{:.0f} mm", to_mm(error.sigma)) : "not in the picture");
  }
  for (const std::string& note : outcome.notes) out += "note: " + note + "\n";
  for (const std::string& weakness : outcome.weaknesses) out += "refused: " + weakness + "\n";
  return out;
}

nlohmann::json place_json(const PlaceOutcome& outcome) {
  const Eigen::Vector3d& at = outcome.place.world_from_sensor.translation();
  const auto [yaw, down] = direction_of(outcome.place);
  nlohmann::json errors = nlohmann::json::array();
  for (const PredictedError& error : outcome.errors) {
    errors.push_back({{"x", error.point.x()},
                      {"z", error.point.z()},
                      {"seen", error.seen},
                      {"errorMm", error.seen ? nlohmann::json(to_mm(error.sigma)) : nullptr}});
  }
  return {{"sensor", outcome.sensor},
          {"x", at.x()},
          {"y", at.y()},
          {"z", at.z()},
          {"yawDeg", yaw},
          {"downDeg", down},
          {"positionSigmaMm", to_mm(position_sigma(outcome.place))},
          {"turnSigmaDeg", to_deg(turn_sigma(outcome.place))},
          {"errorPx", outcome.place.error_px},
          {"sights", outcome.place.sights},
          {"area", std::move(errors)},
          {"notes", outcome.notes},
          {"refused", outcome.weaknesses}};
}

}  // namespace chorus::ctl
