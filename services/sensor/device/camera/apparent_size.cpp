#include "services/sensor/device/camera/apparent_size.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/sensor/pixel_ray.h"

namespace chorus::camera {
namespace {

constexpr std::size_t kFewest = 8;
constexpr double kNearest = 0.3;    // [m]
constexpr double kFarthest = 50.0;  // [m]
constexpr double kOutlier = 0.04;   // Across the ray [m]; beyond it, a landmark's weight decreases.
// Median [m]; beyond it, the landmarks are not a body of that shape.
constexpr double kUseless = 0.15;
// Relative spread of people's sizes about the model's, which is also the relative error of the
// distance.
constexpr double kSizeSigma = 0.10;
constexpr double kShapeSigma = 0.15;  // Along the ray [m]; of one landmark relative to the others.
// Smallest determinant of the fit's matrix, relative to the cube of its mean diagonal; below it,
// all rays are nearly parallel.
constexpr double kLeastSpread = 1e-3;

/// Projector onto the plane perpendicular to the ray.
Eigen::Matrix3d across(const Eigen::Vector3d& ray) {
  return Eigen::Matrix3d::Identity() - ray * ray.transpose();
}

/// The translation that brings the shape closest to the rays.
std::optional<Eigen::Vector3d> shift_to_rays(std::span<const SizedLandmark> landmarks,
                                             const std::vector<double>& weights) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Eigen::Matrix3d weighted = weights[i] * across(landmarks[i].ray);
    normal += weighted;
    right -= weighted * landmarks[i].shape;
  }
  if (!(normal.determinant() > kLeastSpread * std::pow(normal.trace() / 3.0, 3.0)))
    return std::nullopt;
  return normal.inverse() * right;
}

double off_the_ray(const SizedLandmark& landmark, const Eigen::Vector3d& shift) {
  return (across(landmark.ray) * (landmark.shape + shift)).norm();
}

/// Repeats the fit a few times with Huber's weights.
std::optional<Eigen::Vector3d> robust_shift(std::span<const SizedLandmark> landmarks) {
  constexpr int kRounds = 8;
  std::vector<double> weights;
  for (const SizedLandmark& landmark : landmarks) weights.push_back(landmark.weight);
  auto shift = shift_to_rays(landmarks, weights);
  for (int round = 0; shift && round < kRounds; ++round) {
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      const double off = std::max(off_the_ray(landmarks[i], *shift), 1e-9);
      weights[i] = landmarks[i].weight * std::min(1.0, kOutlier / off);
    }
    shift = shift_to_rays(landmarks, weights);
  }
  return shift;
}

bool fits(std::span<const SizedLandmark> landmarks, const Eigen::Vector3d& shift) {
  std::vector<double> off;
  for (const SizedLandmark& landmark : landmarks) {
    if (landmark.weight <= 0.0) continue;
    const double depth = landmark.ray.dot(landmark.shape + shift);
    if (!(depth > kNearest && depth < kFarthest)) return false;
    off.push_back(off_the_ray(landmark, shift));
  }
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return *middle < kUseless;
}

}  // namespace

std::optional<std::vector<PlacedLandmark>> placed_by_size(
    std::span<const SizedLandmark> landmarks) {
  const auto seen = std::count_if(landmarks.begin(), landmarks.end(),
                                  [](const SizedLandmark& one) { return one.weight > 0.0; });
  if (static_cast<std::size_t>(seen) < kFewest) return std::nullopt;
  const auto shift = robust_shift(landmarks);
  if (!shift || !fits(landmarks, *shift)) return std::nullopt;
  std::vector<PlacedLandmark> placed;
  for (const SizedLandmark& landmark : landmarks) {
    const double depth = landmark.ray.dot(landmark.shape + *shift);
    constexpr double kAlong = kShapeSigma * kShapeSigma;
    placed.push_back({depth * landmark.ray, depth * depth * landmark.ray_covariance +
                                                kAlong * landmark.ray * landmark.ray.transpose()});
  }
  return placed;
}

void widen_depth(Joint& joint, double focal_sigma) {
  if (!joint.seen() || !joint.covariance.known()) return;
  const double depth = joint.position.norm();
  if (depth < kNearest) return;
  const Eigen::Vector3d ray = joint.position / depth;
  const double along = std::pow(kSizeSigma * depth, 2) + std::pow(focal_sigma * depth, 2);
  const Eigen::Vector3d aside = focal_sigma * depth * turn_of_focal(ray);
  joint.covariance = Covariance(Eigen::Matrix3d(
      joint.covariance.matrix() + along * ray * ray.transpose() + aside * aside.transpose()));
}

}  // namespace chorus::camera
