#include "fusion-server/registration/ray_views.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>

#include "common/base/median.h"

namespace chorus::registration {
namespace {

constexpr double kForwards = 0.05;       // least z of a ray that OpenCV can take
constexpr std::size_t kMostRays = 1000;  // more take longer and say nothing new
constexpr double kSampsonLimit = 0.015;  // about two sigmas of a network's landmarks at 3 m
constexpr double kPassing = 0.035;       // [tan] a ray this far from its point does not agree
constexpr double kConfidence = 0.999;
constexpr int kDraws = 1000;

bool is_forward(const Eigen::Vector3d& ray) { return ray.z() > kForwards; }

cv::Point2d pixel_of(const Eigen::Vector3d& ray) { return {ray.x() / ray.z(), ray.y() / ray.z()}; }

Error too_few(std::size_t common) {
  return {ErrorCode::NotFound, "rays",
          "only " + std::to_string(common) + " of " + std::to_string(kLeastCommon) +
              " common rays that are needed"};
}

Eigen::Isometry3d isometry_of(const cv::Mat& rotation, const cv::Mat& shift) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      out.linear()(row, column) = rotation.at<double>(row, column);
    out.translation()[row] = shift.at<double>(row);
  }
  return out;
}

struct PixelPairs {
  std::vector<cv::Point2d> first;
  std::vector<cv::Point2d> second;
  std::vector<std::size_t> index;
};

PixelPairs pixel_pairs(const CommonRays& rays) {
  const std::size_t step = 1 + rays.first.size() / kMostRays;
  PixelPairs pairs;
  for (std::size_t i = 0; i < rays.first.size(); i += step) {
    if (!is_forward(rays.first[i]) || !is_forward(rays.second[i])) continue;
    pairs.first.push_back(pixel_of(rays.first[i]));
    pairs.second.push_back(pixel_of(rays.second[i]));
    pairs.index.push_back(i);
  }
  return pairs;
}

/// OpenCV reports some degenerate cases by exceptions.
template <class Estimate>
auto guarded(const Estimate& estimate) -> decltype(estimate()) {
  try {
    return estimate();
  } catch (const cv::Exception& thrown) {
    return fail(ErrorCode::Unavailable, "rays", "no place fits its rays: " + thrown.err);
  }
}

/// The median angle that is left when one rotation takes the second camera's rays to the first's:
/// where cameras are only turned, there is no other parallax, whatever an essential matrix fits.
double beyond_turn(const CommonRays& rays, const std::vector<std::size_t>& index) {
  Eigen::Matrix3d both = Eigen::Matrix3d::Zero();
  for (const std::size_t i : index) both += rays.first[i] * rays.second[i].transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(both, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d proper = Eigen::Matrix3d::Identity();
  proper(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d turn = svd.matrixU() * proper * svd.matrixV().transpose();
  std::vector<double> angles;
  for (const std::size_t i : index) {
    const Eigen::Vector3d second = turn * rays.second[i];
    angles.push_back(std::atan2(rays.first[i].cross(second).norm(), rays.first[i].dot(second)));
  }
  return angles.empty() ? 0.0 : median(std::move(angles));
}

Result<TwoViews> two_views_of(const CommonRays& rays) {
  const PixelPairs pairs = pixel_pairs(rays);
  if (pairs.first.size() < kLeastCommon) return tl::unexpected(too_few(pairs.first.size()));
  const cv::Mat lens = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat mask;
  const cv::Mat essential = cv::findEssentialMat(pairs.first, pairs.second, lens, cv::RANSAC,
                                                 kConfidence, kSampsonLimit, kDraws, mask);
  if (essential.rows != 3 || essential.cols != 3)
    return fail(ErrorCode::Unavailable, "rays", "no essential matrix fits the common rays");
  cv::Mat rotation;
  cv::Mat shift;
  const int agreeing =
      cv::recoverPose(essential, pairs.first, pairs.second, lens, rotation, shift, mask);
  TwoViews views;
  views.first_from_second = isometry_of(rotation, shift).inverse();
  views.common = pairs.first.size();
  views.agreeing = static_cast<std::size_t>(std::max(0, agreeing));
  std::vector<double> angles;
  for (std::size_t i = 0; i < pairs.index.size(); ++i) {
    if (mask.at<unsigned char>(static_cast<int>(i)) == 0) continue;
    const Eigen::Vector3d& first = rays.first[pairs.index[i]];
    const Eigen::Vector3d second = views.first_from_second.linear() * rays.second[pairs.index[i]];
    angles.push_back(std::atan2(first.cross(second).norm(), first.dot(second)));
  }
  if (angles.empty()) return fail(ErrorCode::Unavailable, "rays", "no common rays meet");
  views.parallax = median(std::move(angles));
  views.beyond_turn = beyond_turn(rays, pairs.index);
  return views;
}

Result<FoundPlace> place_of(const KnownPoints& known) {
  const std::size_t step = 1 + known.points.size() / kMostRays;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (std::size_t i = 0; i < known.points.size(); i += step) {
    if (!is_forward(known.rays[i])) continue;
    points.emplace_back(known.points[i].x(), known.points[i].y(), known.points[i].z());
    pixels.push_back(pixel_of(known.rays[i]));
  }
  if (points.size() < kLeastCommon) return tl::unexpected(too_few(points.size()));
  cv::Mat turn;
  cv::Mat shift;
  std::vector<int> inliers;
  const bool found = cv::solvePnPRansac(points, pixels, cv::Mat::eye(3, 3, CV_64F), cv::noArray(),
                                        turn, shift, false, kDraws, static_cast<float>(kPassing),
                                        kConfidence, inliers, cv::SOLVEPNP_EPNP);
  if (!found || inliers.empty())
    return fail(ErrorCode::Unavailable, "rays", "no place fits its rays");
  cv::Mat rotation;
  cv::Rodrigues(turn, rotation);
  FoundPlace place;
  place.points_from_camera = isometry_of(rotation, shift).inverse();
  place.agreeing = static_cast<double>(inliers.size()) / static_cast<double>(points.size());
  if (!place.points_from_camera.matrix().allFinite())
    return fail(ErrorCode::Unavailable, "rays", "no place fits its rays");
  return place;
}

}  // namespace

Result<TwoViews> two_views(const CommonRays& rays) {
  return guarded([&] { return two_views_of(rays); });
}

Result<FoundPlace> place_among(const KnownPoints& known) {
  return guarded([&] { return place_of(known); });
}

}  // namespace chorus::registration
