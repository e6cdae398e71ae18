#include "common/calibration/place_verdict.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/sensor/pixel_ray.h"

namespace chorus::calibration {
namespace {

constexpr double kHips = 1.0;  // [m]

using Matrix37 = Eigen::Matrix<double, 3, 7>;

/// How a point that keeps its pixel and distance moves with the camera's pose and focal length.
Matrix37 motion_of(const CameraPlace& place, const Eigen::Vector3d& point) {
  const Eigen::Vector3d arm = point - place.world_from_sensor.translation();
  Matrix37 motion;
  // A turn w of the camera moves the point by w x arm.
  motion.leftCols<3>() << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(), 0.0;
  motion.middleCols<3>(3).setIdentity();
  const Eigen::Vector3d in_camera = camera_from_sensor_axes() *
                                    place.world_from_sensor.linear().transpose() *
                                    arm.stableNormalized();
  motion.col(6) = arm.norm() * place.world_from_sensor.linear() * camera_from_sensor_axes() *
                  turn_of_focal(in_camera);
  return motion;
}

bool is_seen(const CameraPlace& place, const Intrinsics& lens, const Eigen::Vector3d& point) {
  const Eigen::Vector3d in_camera =
      camera_from_sensor_axes() * (place.world_from_sensor.inverse() * point);
  const auto pixel = pixel_of(in_camera, lens);
  return pixel && pixel->x() > 0.0 && pixel->x() < lens.width && pixel->y() > 0.0 &&
         pixel->y() < lens.height;
}

std::string advice(const PlaceQuestion& question) {
  std::string out = "bring the board nearer or use a larger one";
  if (question.sights.size() < 3) out += "; show it in several places of the area";
  out += "; or measure marks on the floor (--mark)";
  constexpr double kSureLens = 0.005;
  if (question.focal_sigma > kSureLens)
    out += fmt::format("; calibrate the lens, whose focal length is known to {:.1f} % only",
                       100.0 * question.focal_sigma);
  return out;
}

}  // namespace

PredictedError error_at(const CameraPlace& place, const Intrinsics& lens,
                        const Eigen::Vector3d& point) {
  PredictedError out{point, 0.0, is_seen(place, lens, point)};
  if (!out.seen) return out;
  const Matrix37 motion = motion_of(place, point);
  out.sigma = std::sqrt((motion * place.with_focal * motion.transpose()).trace());
  return out;
}

std::vector<PredictedError> errors_in(const CameraPlace& place, const Intrinsics& lens,
                                      const Area& area) {
  std::vector<PredictedError> out;
  for (const auto& [x, z] : {std::pair{-0.5, -0.5}, std::pair{0.5, -0.5}, std::pair{0.5, 0.5},
                             std::pair{-0.5, 0.5}, std::pair{0.0, 0.0}})
    out.push_back(error_at(place, lens, {x * area.across, kHips, z * area.deep}));
  return out;
}

std::vector<std::string> place_weaknesses(const std::vector<PredictedError>& errors,
                                          const PlaceQuestion& question,
                                          const PlaceDemands& demands) {
  std::vector<std::string> out;
  const auto worst = std::max_element(
      errors.begin(), errors.end(),
      [](const PredictedError& a, const PredictedError& b) { return a.sigma < b.sigma; });
  const bool any = std::any_of(errors.begin(), errors.end(),
                               [](const PredictedError& error) { return error.seen; });
  if (!any)
    out.push_back(
        "the camera sees no corner of the area, nor its middle; turn it, or move the "
        "board to where people will be");
  if (any && worst->sigma > demands.error)
    out.push_back(fmt::format(
        "a person at ({:.1f}, {:.1f}) m would be misplaced by {:.0f} mm, more than {:.0f}: {}",
        worst->point.x(), worst->point.z(), to_mm(worst->sigma), to_mm(demands.error),
        advice(question)));
  return out;
}

}  // namespace chorus::calibration
