#include "fusion-server/registration/icp.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <numbers>

#include <pcl/console/print.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_rejection_trimmed.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>
#include <Eigen/Core>

#include "common/geometry/rotation.h"

namespace chorus::registration {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Icp = pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ, double>;

constexpr int kRefineIterations = 20;
constexpr int kSeedIterations = 40;
constexpr int kYawSeeds = 24;         // 15 deg apart
constexpr float kKeptShare = 0.9F;    // trimmed ICP
constexpr double kIcpSettled = 1e-9;  // of the last step, in squared metres and as 1 - cos
constexpr std::size_t kMaxCloudPoints =
    300;  // a 10 s walk at 30 Hz; more costs time without benefit
constexpr std::size_t kMinPoints = 10;

/// Finds nearest neighbours among a few hundred points by testing them all: several times faster
/// than a k-d tree, which spends more time on locks than on such a search.
class Scan : public pcl::search::KdTree<pcl::PointXYZ> {
 public:
  void setInputCloud(const PointCloudConstPtr& cloud, const IndicesConstPtr& /*all*/) override {
    input_ = cloud;
    points_.resize(static_cast<Eigen::Index>(cloud->size()), 3);
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      points_.row(static_cast<Eigen::Index>(i)) = (*cloud)[i].getVector3fMap();
    }
  }

  /// Returns only the nearest point, whatever k is, because ICP needs no more.
  int nearestKSearch(const pcl::PointXYZ& point, int /*k*/, pcl::Indices& indices,
                     std::vector<float>& squares) const override {
    if (points_.rows() == 0) return 0;
    squares_ = (points_.col(0) - point.x).square() + (points_.col(1) - point.y).square() +
               (points_.col(2) - point.z).square();
    const float least = squares_.minCoeff();
    const float* const first = squares_.data();
    const float* const nearest = std::find(first, first + squares_.size() - 1, least);
    indices.assign(1, static_cast<pcl::index_t>(nearest - squares_.data()));
    squares.assign(1, least);
    return 1;
  }

 private:
  Eigen::Array<float, Eigen::Dynamic, 3> points_;
  /// Squared distances of the last search; an ICP is used by one thread only.
  mutable Eigen::ArrayXf squares_;
};

/// At most kMaxCloudPoints points, evenly chosen.
Points::Ptr cloud_of(Cloud points) {
  Points::Ptr cloud(new Points);
  const std::size_t step =
      std::max<std::size_t>(1, (points.size() + kMaxCloudPoints - 1) / kMaxCloudPoints);
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Eigen::Vector3f p = points[i].cast<float>();
    if (p.allFinite()) cloud->push_back({p.x(), p.y(), p.z()});
  }
  return cloud;
}

Eigen::Vector3d centroid(const Points& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : cloud) sum += p.getVector3fMap().cast<double>();
  return sum / static_cast<double>(std::max<std::size_t>(1, cloud.size()));
}

void set_up(Icp& icp, const Points::Ptr& source, const Points::Ptr& target, int iterations) {
  // PCL would write to standard error by itself, past our log, and wait for whoever should read it.
  static const bool silenced = (pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS), true);
  static_cast<void>(silenced);
  icp.setSearchMethodTarget(std::make_shared<Scan>());
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setMaximumIterations(iterations);
  icp.setTransformationEpsilon(kIcpSettled);
  icp.setEuclideanFitnessEpsilon(kIcpSettled);
}

/// Runs from `start`; the residual is the rms of the kept nearest distances.
std::optional<IcpFit> run(Icp& icp, const Eigen::Isometry3d& start, double kept_share) {
  Points moved;
  icp.align(moved, start.matrix());
  if (!icp.hasConverged() || moved.empty()) return std::nullopt;
  std::vector<float> squares;
  std::vector<int> index(1);
  std::vector<float> square(1);
  for (const auto& p : moved) {
    if (icp.getSearchMethodTarget()->nearestKSearch(p, 1, index, square) > 0) {
      squares.push_back(square[0]);
    }
  }
  std::sort(squares.begin(), squares.end());
  IcpFit fit;
  fit.accepted = static_cast<std::size_t>(kept_share * static_cast<double>(squares.size()));
  double sum = 0.0;
  for (std::size_t i = 0; i < fit.accepted; ++i) sum += static_cast<double>(squares[i]);
  if (fit.accepted == 0) return std::nullopt;
  fit.rms = std::sqrt(sum / static_cast<double>(fit.accepted));
  const Eigen::Matrix4d matrix = icp.getFinalTransformation();
  fit.target_from_source.linear() =
      Eigen::Quaterniond(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>()))
          .normalized()
          .toRotationMatrix();
  fit.target_from_source.translation() = matrix.topRightCorner<3, 1>();
  return fit;
}

Eigen::Isometry3d seed(double yaw, const Eigen::Vector3d& target, const Eigen::Vector3d& source) {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  target_from_source.linear() = about_y(yaw).toRotationMatrix();
  target_from_source.translation() = target - target_from_source.linear() * source;
  return target_from_source;
}

std::optional<IcpFit> best_of_seeds(const Points::Ptr& from, const Points::Ptr& to) {
  Icp icp;
  set_up(icp, from, to, kSeedIterations);
  auto trimmed = std::make_shared<pcl::registration::CorrespondenceRejectorTrimmed>();
  trimmed->setOverlapRatio(kKeptShare);
  icp.addCorrespondenceRejector(trimmed);
  std::optional<IcpFit> best;
  for (int i = 0; i < kYawSeeds; ++i) {
    const double yaw = 2.0 * std::numbers::pi * i / kYawSeeds;
    const auto fit = run(icp, seed(yaw, centroid(*to), centroid(*from)), kKeptShare);
    if (fit && (!best || fit->rms < best->rms)) best = fit;
  }
  return best;
}

}  // namespace

std::optional<IcpFit> refine_by_icp(Cloud source, Cloud target, const Eigen::Isometry3d& start,
                                    double reach) {
  try {
    const Points::Ptr from = cloud_of(source);
    const Points::Ptr to = cloud_of(target);
    if (from->size() < kMinPoints || to->size() < kMinPoints) return std::nullopt;
    Icp icp;
    set_up(icp, from, to, kRefineIterations);
    icp.setMaxCorrespondenceDistance(reach);
    return run(icp, start, 1.0);
  } catch (const std::exception&) {  // PCL throws on degenerate clouds; the caller keeps the start
    return std::nullopt;
  }
}

Result<IcpFit> icp_from_yaw_seeds(Cloud source, Cloud target) {
  try {
    const Points::Ptr from = cloud_of(source);
    const Points::Ptr to = cloud_of(target);
    if (from->size() >= kMinPoints && to->size() >= kMinPoints) {
      if (const auto best = best_of_seeds(from, to)) return *best;
    }
  } catch (const std::exception& error) {
    return fail(ErrorCode::InvalidArgument, "icp", error.what());
  }
  return fail(ErrorCode::InvalidArgument, "icp",
              "the neck clouds are too small or too degenerate to be matched");
}

}  // namespace chorus::registration
