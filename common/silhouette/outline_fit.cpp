#include "common/silhouette/outline_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/sensor/pixel_ray.h"

namespace chorus::silhouette {
namespace {

constexpr std::size_t kFewestPoints = 20;
constexpr int kOuter = 4;  // The outline is made anew.
constexpr int kInner = 4;
constexpr double kConverged = 5e-4;  // [m]
constexpr double kGridStep = 0.2;    // [m]
constexpr double kLeastInside = 0.3;
constexpr double kInwards = 4.0;  // How far inside the region is asked [px].
// Neighbouring points of an outline err alike: one in so many counts.
constexpr double kAlike = 8.0;
constexpr double kLeastNoise = 2.0;  // Of an edge [px].

std::vector<OutlinePoint> outline_at(const SearchView& view, const Eigen::Vector3d& shift,
                                     double spacing) {
  const auto capsules =
      flat_capsules(shifted(view.body, shift), view.shape, view.world_from_sensor, view.camera);
  std::vector<OutlinePoint> out = outline_of(capsules, spacing);
  std::erase_if(out, [&](const OutlinePoint& point) {
    return point.pixel.x() < 0.0 || point.pixel.y() < 0.0 ||
           point.pixel.x() > view.camera.width - 1.0 || point.pixel.y() > view.camera.height - 1.0;
  });
  return out;
}

double mean_distance(const std::vector<OutlinePoint>& outline, const Evidence& evidence) {
  double sum = 0.0;
  for (const OutlinePoint& point : outline) sum += evidence.distance(point.pixel);
  return sum / std::max(1.0, static_cast<double>(outline.size()));
}

/// An outline's point in the camera's axes, at its capsule's depth; none outside the lens's model.
/// Brown's distortion, which hardly changes how the point moves, is left out.
std::optional<Eigen::Vector3d> in_camera(const OutlinePoint& point, const Intrinsics& camera) {
  if (camera.model == LensModel::Brown)
    return point.depth * Eigen::Vector3d((point.pixel.x() - camera.cx) / camera.fx,
                                         (point.pixel.y() - camera.cy) / camera.fy, 1.0);
  const auto ray = ray_of(point.pixel, camera);
  if (!ray || !(ray->z() > 0.0)) return std::nullopt;
  return *ray / ray->z() * point.depth;
}

/// How the pixel of an outline's point moves with the body, in world axes, and how it swells
/// [px/m].
struct PointSlope {
  Eigen::Matrix<double, 2, 3> moves;
  double swells = 0.0;
};

std::optional<PointSlope> slope_at(const SearchView& view, const OutlinePoint& point) {
  const auto place = in_camera(point, view.camera);
  if (!place) return std::nullopt;
  return PointSlope{pixel_slope(*place, view.camera) * camera_from_sensor_axes() *
                        view.world_from_sensor.linear().transpose(),
                    pixels_per_metre(*place, view.camera)};
}

/// How far the body is moved, and by how much it is thicker all around than its shape [m].
using Unknowns = Eigen::Vector4d;

struct Normal {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
};

Normal normal_at(const SearchView& view, const std::vector<OutlinePoint>& outline,
                 const Unknowns& since, const OutlineSettings& settings) {
  Normal normal;
  for (const OutlinePoint& point : outline) {
    const auto by = slope_at(view, point);
    if (!by) continue;
    const Eigen::Matrix<double, 2, 3>& moves = by->moves;
    const Eigen::Vector2d swells = by->swells * point.normal;
    const Eigen::Vector2d pixel = point.pixel + moves * since.head<3>() + swells * since[3];
    const double away = view.evidence.distance(pixel);
    const Eigen::Vector2d slope = view.evidence.slope(pixel);
    // An edge that runs across the outline is not this outline's.
    if (slope.norm() > 0.3 && std::abs(slope.normalized().dot(point.normal)) < 0.5) continue;
    const double weight = 1.0 / (1.0 + std::pow(away / settings.cauchy_px, 2));
    Unknowns row;
    row.head<3>() = moves.transpose() * slope;
    row[3] = swells.dot(slope);
    if (settings.over_floor) row.y() = 0.0;
    normal.matrix += weight * row * row.transpose();
    normal.right -= weight * row * away;
  }
  if (settings.over_floor) normal.matrix(1, 1) = std::max(1.0, normal.matrix(0, 0));
  // Clothes and girth: the shape is about as thick as this says.
  const double known = std::pow(kLeastNoise / settings.thickness, 2) * kAlike;
  normal.matrix(3, 3) += known;
  normal.right[3] -= known * since[3];
  return normal;
}

Unknowns step_of(const Normal& normal, double most) {
  Eigen::Matrix4d damped = normal.matrix;
  damped.diagonal().array() +=
      1e-3 * normal.matrix.topLeftCorner<3, 3>().diagonal().maxCoeff() + 1e-9;
  const Unknowns step = damped.ldlt().solve(normal.right);
  if (!step.allFinite()) return Unknowns::Zero();
  return step.norm() > most ? Unknowns(most * step.normalized()) : step;
}

/// The best place of a coarse grid, and whether another one is as good.
std::pair<Eigen::Vector3d, bool> coarse(const SearchView& view, const OutlineSettings& settings) {
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::pair<Eigen::Vector3d, double>> all;
  const int reach = static_cast<int>(std::lround(settings.reach / kGridStep));
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const Eigen::Vector3d shift(i * kGridStep, 0.0, j * kGridStep);
      const auto outline = outline_at(view, shift, 3.0 * settings.spacing_px);
      if (outline.size() < kFewestPoints / 2) continue;
      const double mean = mean_distance(outline, view.evidence);
      all.emplace_back(shift, mean);
      if (mean >= least) continue;
      least = mean;
      best = shift;
    }
  }
  const bool ambiguous = std::any_of(all.begin(), all.end(), [&](const auto& one) {
    return (one.first - best).norm() > 1.6 * kGridStep && one.second < 1.1 * least;
  });
  return {best, ambiguous};
}

Eigen::Vector3d refined(const SearchView& view, Eigen::Vector3d shift,
                        const OutlineSettings& settings) {
  double thicker = 0.0;
  for (int outer = 0; outer < kOuter; ++outer) {
    const auto outline = outline_at(view, shift, settings.spacing_px);
    Unknowns since(0.0, 0.0, 0.0, thicker);
    for (int inner = 0; inner < kInner; ++inner) {
      const Unknowns step = step_of(normal_at(view, outline, since, settings), settings.most_shift);
      since += step;
      if (step.norm() < kConverged) break;
    }
    Eigen::Vector3d by = since.head<3>();
    thicker = since[3];
    if (by.norm() > 2.0 * settings.most_shift) by *= 2.0 * settings.most_shift / by.norm();
    shift += by;
    if (by.norm() < kConverged) break;
  }
  return shift;
}

double inside_share(const std::vector<OutlinePoint>& outline, const Evidence& evidence) {
  double inside = 0.0;
  for (const OutlinePoint& point : outline)
    inside += evidence.is_foreground(point.pixel - kInwards * point.normal) ? 1.0 : 0.0;
  return inside / std::max(1.0, static_cast<double>(outline.size()));
}

}  // namespace

std::optional<OutlineFit> fit_outline(const SearchView& view, const OutlineSettings& settings) {
  OutlineFit out;
  out.shift = refined(view, out.shift, settings);
  auto outline = outline_at(view, out.shift, settings.spacing_px);
  out.mean_px = mean_distance(outline, view.evidence);
  const bool lost = outline.size() < kFewestPoints || out.mean_px > settings.lost_px;
  if (lost && settings.reach > 0.0) {
    const auto [start, ambiguous] = coarse(view, settings);
    const Eigen::Vector3d other = refined(view, start, settings);
    const auto other_outline = outline_at(view, other, settings.spacing_px);
    const double other_mean = mean_distance(other_outline, view.evidence);
    if (other_outline.size() >= kFewestPoints &&
        (outline.size() < kFewestPoints || other_mean < out.mean_px)) {
      out = {other, Eigen::Matrix3d::Zero(), other_mean, 0.0, ambiguous};
      outline = other_outline;
    }
  }
  if (outline.size() < kFewestPoints) return std::nullopt;
  out.inside = inside_share(outline, view.evidence);
  if (out.inside < kLeastInside) return std::nullopt;
  const Normal normal = normal_at(view, outline, Unknowns::Zero(), settings);
  const double noise = std::max(kLeastNoise, out.mean_px);
  Eigen::Matrix4d information = normal.matrix / (noise * noise * kAlike);
  if (settings.over_floor) information(1, 1) = 0.0;  // The height was not measured.
  information.diagonal().array() += 1e-2;
  out.covariance = information.inverse().topLeftCorner<3, 3>();
  return out;
}

}  // namespace chorus::silhouette
