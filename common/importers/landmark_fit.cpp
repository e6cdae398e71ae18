#include "common/importers/landmark_fit.h"

#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>

#include "common/layout/tables.h"
#include "common/sensor/pixel_ray.h"

namespace chorus::importers {
namespace {

/// Where nose, eyes, ears and mouth, the first landmarks, lie in head axes [m]: as four cameras
/// place them in the person of tests/data/pose2sim_mediapipe, made symmetric.  Eight other cameras
/// and two other people (docs/benchmarks/ergonomics.md) give the same within 6 mm (ears: 10 mm).
const std::vector<cv::Point3d> kFace{
    {0.0, -0.014, 0.025},     {0.0145, 0.015, 0.0105},  {0.0235, 0.015, 0.007},
    {0.0335, 0.016, 0.0025},  {-0.0145, 0.015, 0.0105}, {-0.0235, 0.015, 0.007},
    {-0.0335, 0.016, 0.0025}, {0.049, 0.005, -0.039},   {-0.049, 0.005, -0.039},
    {0.016, -0.0435, 0.007},  {-0.016, -0.0435, 0.007}};

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

struct Pose {
  cv::Vec3d turn;
  cv::Vec3d shift;
};

struct CameraFit {
  std::array<Eigen::Vector3d, kLandmarkCount> in_camera;  ///< OpenCV axes.
  std::vector<cv::Point2d> ray;                           ///< x/z, y/z of each undistorted pixel.
};

std::vector<double> distortion_of(const Intrinsics& k) {
  return {k.distortion.begin(), k.distortion.end()};
}

/// Levenberg-Marquardt from `pose`.  May throw cv::Exception.
void refine(const PixelsAndBody& points, const Intrinsics& intrinsics, Pose& pose) {
  cv::solvePnPRefineLM(points.in_body, points.pixel, camera_matrix(intrinsics),
                       distortion_of(intrinsics), pose.turn, pose.shift);
}

/// SQPnP, then Levenberg-Marquardt.  OpenCV's default iterative start ends in mirrored poses for
/// views from behind (off by metres for one of the four bundled cameras).  May throw cv::Exception.
std::optional<Pose> fit_pose(const PixelsAndBody& points, const Intrinsics& intrinsics) {
  Pose pose;
  if (!cv::solvePnP(points.in_body, points.pixel, camera_matrix(intrinsics),
                    distortion_of(intrinsics), pose.turn, pose.shift, false, cv::SOLVEPNP_SQPNP))
    return std::nullopt;
  refine(points, intrinsics, pose);
  return pose;
}

CameraFit posed(const PixelsAndBody& points, const Intrinsics& intrinsics, const Pose& pose) {
  cv::Matx33d rotation;
  cv::Rodrigues(pose.turn, rotation);
  CameraFit fit;
  for (std::size_t i = 0; i < points.in_body.size(); ++i) {
    const cv::Vec3d x = rotation * cv::Vec3d(points.in_body[i]) + pose.shift;
    fit.in_camera[i] = {x[0], x[1], x[2]};
  }
  cv::undistortPoints(points.pixel, fit.ray, camera_matrix(intrinsics), distortion_of(intrinsics));
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
    const auto points = for_opencv(detected);
    const auto pose = fit_pose(points, intrinsics);
    if (pose) fit = posed(points, intrinsics, *pose);
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

std::optional<Eigen::Quaterniond> fit_head(const DetectedLandmarks& detected,
                                           const Intrinsics& intrinsics) {
  const auto body = fit_landmarks(detected, intrinsics, Lateral::RigidBody);
  const auto start = body ? layout::head_turn(layout::kMediapipe, *body) : std::nullopt;
  if (!start) return std::nullopt;
  PixelsAndBody face{kFace, {}};
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < kFace.size(); ++i) {
    face.pixel.emplace_back(detected.pixel[i].x(), detected.pixel[i].y());
    middle += (*body)[i].position / static_cast<double>(kFace.size());
  }
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(sensor_from_opencv()) * *start);
  const Eigen::Vector3d vector = turn.angle() * turn.axis();
  const Eigen::Vector3d shift = sensor_from_opencv() * middle;
  Pose pose{{vector.x(), vector.y(), vector.z()}, {shift.x(), shift.y(), shift.z()}};
  cv::Matx33d rotation;
  try {
    refine(face, intrinsics, pose);
    cv::Rodrigues(pose.turn, rotation);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> fitted(rotation.val);
  if (!fitted.allFinite()) return std::nullopt;
  return Eigen::Quaterniond(sensor_from_opencv() * fitted);
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
