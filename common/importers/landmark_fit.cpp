#include "common/importers/landmark_fit.h"

#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>

#include "common/sensor/pixel_ray.h"

namespace chorus::importers {
namespace {

/// A landmark nearer to the camera's plane than this, or behind it, is not tracked [m].
constexpr double kMinDepth = 0.1;

cv::Matx33d camera_matrix(const Intrinsics& k) {
  return {k.fx, 0.0, k.cx, 0.0, k.fy, k.cy, 0.0, 0.0, 1.0};
}

struct PixelsAndBody {
  std::vector<cv::Point3d> in_body;
  std::vector<cv::Point2d> pixel;
};

PixelsAndBody for_opencv(const DetectedLandmarks& detected) {
  PixelsAndBody points;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    points.in_body.emplace_back(detected.in_body[i].x(), detected.in_body[i].y(),
                                detected.in_body[i].z());
    points.pixel.emplace_back(detected.pixel[i].x(), detected.pixel[i].y());
  }
  return points;
}

struct CameraFit {
  std::array<Eigen::Vector3d, kLandmarkCount> in_camera;  ///< OpenCV axes.
  std::vector<cv::Point2d> ray;                           ///< x/z, y/z of each undistorted pixel.
};

/// SQPnP, then Levenberg-Marquardt.  OpenCV's default iterative start ends in mirrored poses for
/// views from behind (off by metres for one of the four bundled cameras).  May throw cv::Exception.
std::optional<CameraFit> fit_camera(const PixelsAndBody& points, const Intrinsics& intrinsics) {
  const cv::Matx33d k = camera_matrix(intrinsics);
  const std::vector<double> distortion(intrinsics.distortion.begin(), intrinsics.distortion.end());
  cv::Vec3d turn;
  cv::Vec3d shift;
  if (!cv::solvePnP(points.in_body, points.pixel, k, distortion, turn, shift, false,
                    cv::SOLVEPNP_SQPNP))
    return std::nullopt;
  cv::solvePnPRefineLM(points.in_body, points.pixel, k, distortion, turn, shift);
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  CameraFit fit;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const cv::Vec3d x = rotation * cv::Vec3d(points.in_body[i]) + shift;
    fit.in_camera[i] = {x[0], x[1], x[2]};
  }
  cv::undistortPoints(points.pixel, fit.ray, k, distortion);
  return fit;
}

JointState state_of(double visibility) {
  return visibility >= kTrackedVisibility ? JointState::Tracked : JointState::Inferred;
}

layout::Landmark landmark_of(const CameraFit& fit, std::size_t i, double visibility,
                             Lateral lateral) {
  Eigen::Vector3d x_in_camera = fit.in_camera[i];
  const double depth = x_in_camera.z();
  if (!x_in_camera.allFinite() || depth < kMinDepth) return {};
  if (lateral == Lateral::PixelRay)
    x_in_camera = Eigen::Vector3d(fit.ray[i].x * depth, fit.ray[i].y * depth, depth);
  return {sensor_from_opencv() * x_in_camera, state_of(visibility)};
}

}  // namespace

Result<Landmarks> fit_landmarks(const DetectedLandmarks& detected, const Intrinsics& intrinsics,
                                Lateral lateral) {
  std::optional<CameraFit> fit;
  try {
    fit = fit_camera(for_opencv(detected), intrinsics);
  } catch (const cv::Exception& refused) {
    return fail(ErrorCode::InvalidArgument, "landmarks", refused.err);
  }
  Landmarks landmarks;
  std::size_t in_front = 0;
  for (std::size_t i = 0; fit && i < kLandmarkCount; ++i) {
    landmarks[i] = landmark_of(*fit, i, detected.visibility[i], lateral);
    in_front += landmarks[i].state != JointState::NotTracked ? 1 : 0;
  }
  if (in_front < kLandmarkCount / 2)
    return fail(ErrorCode::InvalidArgument, "landmarks",
                "the pixels fit no body before the camera.");
  return landmarks;
}

Covariance fit_error(const Joint& joint) {
  constexpr double kAcross = 0.025;  // [m]
  constexpr double kOfRange = 0.06;  // relative to the distance
  constexpr double kInferred = 2.0;  // Factor for an Inferred joint.
  const double range = joint.position.norm();
  if (!joint.seen() || !(range > 0.0)) return {};
  const double factor = joint.state == JointState::Inferred ? kInferred : 1.0;
  const Eigen::Vector3d ray = joint.position / range;
  const double across = std::pow(factor * kAcross, 2);
  const double along = std::pow(factor * kOfRange * range, 2) + across;
  return Covariance(Eigen::Matrix3d(across * Eigen::Matrix3d::Identity() +
                                    (along - across) * ray * ray.transpose()));
}

Landmarks landmark_rays(const DetectedLandmarks& detected, const Intrinsics& intrinsics) {
  Landmarks landmarks;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const auto ray = ray_of(detected.pixel[i], intrinsics);
    if (!ray) continue;
    landmarks[i] = {sensor_from_opencv() * *ray, state_of(detected.visibility[i]),
                    Measurement::Ray};
  }
  return landmarks;
}

}  // namespace chorus::importers
