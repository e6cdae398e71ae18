#include "common/silhouette/search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace chorus::silhouette {
namespace {

constexpr int kDirections = 8;
constexpr int kFraction = 4;  // Bits of the fraction of OpenCV's coordinates.

/// A pixel of the picture in the evidence's field, as OpenCV wants it.
cv::Point fixed(const Eigen::Vector2d& pixel, const Evidence& evidence) {
  constexpr double kOne = 1 << kFraction;
  constexpr double kMost = 1e5;  // Far outside, and still a number that OpenCV can hold.
  const auto in = [&](double value, int origin) {
    const double there = (value + 0.5) * evidence.scale() - 0.5 - origin;
    return static_cast<int>(std::lround(std::clamp(there, -kMost, kMost) * kOne));
  };
  return {in(pixel.x(), evidence.origin().x()), in(pixel.y(), evidence.origin().y())};
}

void fill(const FlatCapsule& capsule, const Evidence& evidence, cv::Mat& out) {
  constexpr double kOne = 1 << kFraction;
  const auto circle = [&](const Eigen::Vector2d& centre, double radius) {
    const double pixels = std::clamp(radius * evidence.scale(), 0.0, 1e4);
    cv::circle(out, fixed(centre, evidence), static_cast<int>(std::lround(pixels * kOne)), 255,
               cv::FILLED, cv::LINE_8, kFraction);
  };
  circle(capsule.a, capsule.a_radius);
  circle(capsule.b, capsule.b_radius);
  const Eigen::Vector2d along = capsule.b - capsule.a;
  if (along.norm() < 1e-6) return;
  const Eigen::Vector2d side = Eigen::Vector2d(-along.y(), along.x()).normalized();
  const std::vector<cv::Point> sides{fixed(capsule.a + capsule.a_radius * side, evidence),
                                     fixed(capsule.b + capsule.b_radius * side, evidence),
                                     fixed(capsule.b - capsule.b_radius * side, evidence),
                                     fixed(capsule.a - capsule.a_radius * side, evidence)};
  cv::fillConvexPoly(out, sides, 255, cv::LINE_8, kFraction);
}

std::vector<Eigen::Vector3d> shifts_of(const SearchSettings& settings) {
  std::vector<Eigen::Vector3d> out{Eigen::Vector3d::Zero()};
  for (int direction = 0; direction < kDirections; ++direction) {
    const double angle = 2.0 * std::numbers::pi * direction / kDirections;
    for (int step = 1; step <= settings.shifts; ++step) {
      const double by = settings.shift * step;
      out.emplace_back(by * std::sin(angle), 0.0, by * std::cos(angle));
    }
  }
  return out;
}

}  // namespace

Skeleton<WorldSpace> shifted(const Skeleton<WorldSpace>& body, const Eigen::Vector3d& by) {
  Skeleton<WorldSpace> out = body;
  for (Joint& joint : out.joints) joint.position += by;
  return out;
}

std::optional<Region> region_around(const SearchView& view, double reach) {
  const auto capsules_at = [&](const Eigen::Vector3d& shift) {
    return flat_capsules(shifted(view.body, shift), view.shape, view.world_from_sensor,
                         view.camera);
  };
  const auto here = capsules_at(Eigen::Vector3d::Zero());
  Region out = box_of(here);
  for (const double x : {-reach, reach}) {
    for (const double z : {-reach, reach}) {
      const auto there = capsules_at({x, 0.0, z});
      if (there.size() != here.size()) return std::nullopt;
      out.extend(box_of(there));
    }
  }
  if (out.isEmpty()) return std::nullopt;
  return out;
}

std::optional<double> energy(std::span<const FlatCapsule> capsules, const Evidence& evidence,
                             double kernel_px) {
  const cv::Mat& field = evidence.field();
  cv::Mat body = cv::Mat::zeros(field.size(), CV_8U);
  for (const FlatCapsule& capsule : capsules) fill(capsule, evidence, body);
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(body, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  cv::Mat silhouette = cv::Mat::zeros(field.size(), CV_8U);
  cv::drawContours(silhouette, contours, -1, 255,
                   std::max(1, static_cast<int>(std::lround(kernel_px))));
  if (cv::countNonZero(silhouette) == 0) return std::nullopt;
  return cv::mean(field, silhouette)[0];
}

std::optional<SearchResult> search(const SearchView& view, const SearchSettings& settings) {
  const std::vector<Eigen::Vector3d> shifts = shifts_of(settings);
  std::vector<double> energies;
  std::optional<SearchResult> best;
  for (const Eigen::Vector3d& shift : shifts) {
    const auto value = energy(
        flat_capsules(shifted(view.body, shift), view.shape, view.world_from_sensor, view.camera),
        view.evidence, settings.kernel_px);
    energies.push_back(value.value_or(std::numeric_limits<double>::infinity()));
    if (value && (!best || *value < best->energy)) best = SearchResult{shift, *value, false};
  }
  if (!best) return std::nullopt;
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    const bool apart = (shifts[i] - best->shift).norm() > 1.6 * settings.shift;
    if (apart && energies[i] < 1.1 * best->energy) best->ambiguous = true;
  }
  return best;
}

}  // namespace chorus::silhouette
