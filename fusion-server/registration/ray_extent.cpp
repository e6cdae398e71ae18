#include "fusion-server/registration/ray_extent.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "common/base/median.h"
#include "common/body/stature.h"

namespace chorus::registration {
namespace {

using enum JointId;

constexpr double kTypicalStature = 1.70;   // [m] of adults; 0.1 is their standard deviation
constexpr double kTrunkOfStature = 0.288;  // hips to shoulders, Drillis and Contini 1966
constexpr std::size_t kLeastLengths = 20;
constexpr double kLeastWalk = 0.25;     // [m] rms about the middle, as min_spread of depth sensors
constexpr double kLeastAcross = 0.08;   // [m] a trunk sways this far aside on a straight line
constexpr double kLeastSlimness = 0.1;  // rms across over rms along; as between depth sensors

using InstantBody = std::map<JointId, Eigen::Vector3d>;

std::vector<InstantBody> instants_of(const std::vector<RayPoint>& points) {
  std::vector<InstantBody> bodies;
  double last = -1.0;
  for (const RayPoint& point : points) {
    if (!point.x) continue;
    if (point.time != last) bodies.emplace_back();
    last = point.time;
    bodies.back()[static_cast<JointId>(point.slot)] = *point.x;
  }
  return bodies;
}

/// The middle of two joints; none unless both are there.
std::optional<Eigen::Vector3d> between(const InstantBody& body, JointId a, JointId b) {
  const auto first = body.find(a);
  const auto second = body.find(b);
  if (first == body.end() || second == body.end()) return std::nullopt;
  return Eigen::Vector3d(0.5 * (first->second + second->second));
}

struct Ends {
  JointId from[2];
  JointId to[2];
};

std::optional<double> length_of(const std::vector<InstantBody>& bodies,
                                std::initializer_list<Ends> alike) {
  std::vector<double> lengths;
  for (const InstantBody& body : bodies) {
    for (const Ends& ends : alike) {
      const auto from = between(body, ends.from[0], ends.from[1]);
      const auto to = between(body, ends.to[0], ends.to[1]);
      if (from && to) lengths.push_back((*from - *to).norm());
    }
  }
  if (lengths.size() < kLeastLengths) return std::nullopt;
  return median(std::move(lengths));
}

}  // namespace

Result<double> metres_per_unit(const std::vector<RayPoint>& points) {
  const std::vector<InstantBody> bodies = instants_of(points);
  const auto shank = length_of(bodies, {{{AnkleLeft, AnkleLeft}, {KneeLeft, KneeLeft}},
                                        {{AnkleRight, AnkleRight}, {KneeRight, KneeRight}}});
  const auto thigh = length_of(bodies, {{{KneeLeft, KneeLeft}, {HipLeft, HipLeft}},
                                        {{KneeRight, KneeRight}, {HipRight, HipRight}}});
  const auto trunk = length_of(bodies, {{{HipLeft, HipRight}, {ShoulderLeft, ShoulderRight}}});
  if (!trunk || !(*trunk > 0.0))
    return fail(ErrorCode::Unavailable, "rays",
                "the cameras hardly saw hips and shoulders of the person together: walk where the "
                "whole body is in their pictures");
  if (shank && thigh) return kTypicalStature * kChainOfStature / (*shank + *thigh + *trunk);
  return kTypicalStature * kTrunkOfStature / *trunk;
}

Result<void> wide_enough(const std::vector<RayPoint>& points) {
  std::vector<Eigen::Vector3d> middles;
  for (const InstantBody& body : instants_of(points)) {
    if (const auto hips = between(body, HipLeft, HipRight)) middles.push_back(*hips);
  }
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& each : middles) middle += each;
  middle /= static_cast<double>(std::max<std::size_t>(1, middles.size()));
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& each : middles)
    scatter += (each - middle) * (each - middle).transpose();
  scatter /= static_cast<double>(std::max<std::size_t>(1, middles.size()));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter, Eigen::EigenvaluesOnly);
  const double along = std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
  const double across = std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
  if (!(std::hypot(along, across) >= kLeastWalk))
    return fail(ErrorCode::Unavailable, "rays",
                fmt::format("the person stayed on the spot ({:.2f} m about the middle, {:.2f} m "
                            "are needed), which does not place cameras without depth: walk to and "
                            "fro and across where they see you",
                            std::hypot(along, across), kLeastWalk));
  if (!(across >= std::max(kLeastAcross, kLeastSlimness * along)))
    return fail(ErrorCode::Unavailable, "rays",
                fmt::format("the walk was one line ({:.1f} m along, {:.2f} m across), which does "
                            "not place cameras without depth: walk across too, in a circle or an "
                            "eight",
                            along, across));
  return {};
}

}  // namespace chorus::registration
